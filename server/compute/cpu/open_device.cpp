#include <algorithm>
#include <charconv>
#include <system_error>

#include <spdlog/fmt/fmt.h>

#include "compute/cpu/device.h"
#include "compute/cpu/host.h"

namespace spherule::compute::cpu {
namespace {

constexpr unsigned mostThreads = 256;

}  // namespace

bool answersTo(const std::string& choice) {
    return choice == "auto" || choice.starts_with("cpu");
}

Result<std::unique_ptr<Device>> openDevice(const std::string& choice, const std::string& passedOver) {
    const std::string kind = choice == "auto" ? "cpu" : choice.substr(0, choice.find(':'));
    unsigned threads = std::min(processors(), mostThreads);
    bool right = kind == "cpu" || kind == "cpu-double";
    if (right && choice.find(':') != std::string::npos) {
        const char* const end = choice.data() + choice.size();
        const auto parsed = std::from_chars(choice.data() + kind.size() + 1, end, threads);
        right = parsed.ec == std::errc() && parsed.ptr == end && threads >= 1 && threads <= mostThreads;
    }
    if (!right) {
        return fail(ErrorKind::Input, "--device",
                    fmt::format("\"{}\" is neither cpu nor cpu:N (N threads, 1 to {}), nor the same with cpu-double",
                                choice, mostThreads));
    }
    const Precision precision = kind == "cpu" ? Precision::Single : Precision::Double;
    try {
        return std::make_unique<CpuDevice>(threads, precision,
                                           choice == "auto" ? passedOver : "asked for as " + choice);
    } catch (const std::system_error& error) {
        return fail(ErrorKind::NoDevice, choice,
                    fmt::format("cannot start {} threads: {}; use --device cpu:N with fewer", threads, error.what()));
    }
}

}  // namespace spherule::compute::cpu
