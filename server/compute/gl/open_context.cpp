#include "compute/gl/open_context.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string_view>

#include <spdlog/fmt/fmt.h>

#include "compute/gl/visible_gpus.h"
#include "core/log.h"

namespace spherule::compute::gl {
namespace {

constexpr std::string_view gpuAdvice =
    "Check that the GPU's driver is installed with its OpenGL part (in a container NVIDIA_DRIVER_CAPABILITIES must "
    "name graphics), see `spherule probe`, or use --device cpu";
constexpr std::string_view softwareAdvice =
    "Install Mesa's software renderer (on Debian: apt install libegl-mesa0 libgl1-mesa-dri)";

Result<std::shared_ptr<Context>> contextOn(const Result<std::shared_ptr<EglDisplay>>& display) {
    if (!display) return tl::unexpected(display.error());
    return Context::create(*display);
}

// Opens displays until one has the wanted kind of renderer, and collects the problems of the others.
class Attempts {
  public:
    bool open(const Result<std::shared_ptr<EglDisplay>>& display, bool wantSoftware) {
        auto context = contextOn(display);
        if (!context) {
            note(context.error().text());
            return false;
        }
        if ((*context)->software() != wantSoftware) {
            note(fmt::format("{}: its renderer is {}", (*context)->display().name(), (*context)->renderer()));
            return false;
        }
        context_ = std::move(*context);
        return true;
    }

    void note(const std::string& problem) {
        if (std::find(problems_.begin(), problems_.end(), problem) != problems_.end()) return;
        spdlog::debug("not used: {}", problem);
        problems_.push_back(problem);
    }

    [[nodiscard]] const std::shared_ptr<Context>& context() const { return context_; }
    [[nodiscard]] std::string problems() const {
        return problems_.empty() ? "" : fmt::format(" ({})", fmt::join(problems_, "; "));
    }

  private:
    std::shared_ptr<Context> context_;
    std::vector<std::string> problems_;
};

std::string cudaNumbers(const std::vector<EglDevice>& devices) {
    std::vector<unsigned> numbers;
    for (const EglDevice& device : devices)
        if (device.cudaNumber) numbers.push_back(*device.cudaNumber);
    return numbers.empty() ? "none" : fmt::format("{}", fmt::join(numbers, ", "));
}

bool openHardware(Attempts& attempts, const Wish& wish, const std::vector<EglDevice>& devices) {
    const bool numbered = wish.gpu || wish.cuda;
    const VisibleGpus gpus = visibleGpus(devices, numbered ? nullptr : std::getenv("CUDA_VISIBLE_DEVICES"));
    for (unsigned place = 0; place < gpus.devices.size(); ++place) {
        const EglDevice& device = *gpus.devices[place];
        if ((wish.gpu && place != wish.gpu) || (wish.cuda && device.cudaNumber != wish.cuda)) continue;
        if (attempts.open(EglDisplay::forDevice(device), false)) return true;
    }
    if (!gpus.note.empty()) attempts.note(gpus.note);
    if (wish.cuda) attempts.note(fmt::format("CUDA numbers here: {}", cudaNumbers(devices)));
    return devices.empty() && !numbered && attempts.open(EglDisplay::surfaceless(false), false);
}

// Opens EGL's software device first: if another vendor's library is installed, only this device is Mesa's for certain.
bool openSoftware(Attempts& attempts, const std::vector<EglDevice>& devices) {
    for (const auto& device : devices) {
        if (device.software() && attempts.open(EglDisplay::forDevice(device), true)) return true;
    }
    return attempts.open(EglDisplay::surfaceless(true), true);
}

std::string gpuName(const Wish& wish) {
    if (wish.cuda) return fmt::format("gpu:cuda:{}", *wish.cuda);
    return wish.gpu ? fmt::format("gpu:{}", *wish.gpu) : "gpu";
}

std::optional<unsigned> numberAfter(std::string_view prefix, const std::string& choice) {
    if (!choice.starts_with(prefix)) return std::nullopt;
    unsigned number = 0;
    const char* const end = choice.data() + choice.size();
    const auto parsed = std::from_chars(choice.data() + prefix.size(), end, number);
    return parsed.ec == std::errc() && parsed.ptr == end ? std::optional(number) : std::nullopt;
}

}  // namespace

Result<Wish> parseWish(const std::string& choice) {
    using Kind = Wish::Kind;
    if (choice == "auto") return Wish{};
    if (choice == "gpu") return Wish{.kind = Kind::Gpu};
    if (choice == "software") return Wish{.kind = Kind::Software};
    if (const auto cuda = numberAfter("gpu:cuda:", choice)) return Wish{.kind = Kind::Gpu, .cuda = cuda};
    if (const auto gpu = numberAfter("gpu:", choice)) return Wish{.kind = Kind::Gpu, .gpu = gpu};
    return fail(ErrorKind::Input, "--device",
                fmt::format("\"{}\" is none of auto, gpu, gpu:N (N from 0), gpu:cuda:N (as CUDA counts), cpu, cpu:N (N "
                            "threads), software",
                            choice));
}

Result<Opened> openContext(const Wish& wish, const std::vector<EglDevice>& devices) {
    Attempts attempts;
    if (wish.kind != Wish::Kind::Software && openHardware(attempts, wish, devices)) {
        const auto& context = attempts.context();
        const auto reason = wish.kind == Wish::Kind::Auto
                                ? fmt::format("a hardware GPU was found ({})", context->display().name())
                                : fmt::format("asked for as {} ({})", gpuName(wish), context->display().name());
        return Opened{context, "gpu", reason};
    }
    if (wish.kind != Wish::Kind::Software) {
        // Without a GPU, `auto` uses the CPU, so no advice is needed.
        const std::string advice = wish.kind == Wish::Kind::Auto ? "" : fmt::format(". {}", gpuAdvice);
        return fail(ErrorKind::NoDevice, gpuName(wish),
                    fmt::format("no GPU here computes with OpenGL 4.5{}{}", attempts.problems(), advice));
    }
    if (openSoftware(attempts, devices))
        return Opened{attempts.context(), "software", "asked for as software: Mesa's renderer on the CPU, slow"};
    return fail(ErrorKind::NoDevice, "software",
                fmt::format("no software renderer{}. {}", attempts.problems(), softwareAdvice));
}

}  // namespace spherule::compute::gl
