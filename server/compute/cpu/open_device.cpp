#include <charconv>

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
    if (choice == "auto") return std::make_unique<CpuDevice>(processors(), Precision::Single, passedOver);
    const std::string kind = choice.substr(0, choice.find(':'));
    unsigned threads = processors();
    bool right = kind == "cpu" || kind == "cpu-double";
    if (right && kind.size() < choice.size()) {
        const char* const end = choice.data() + choice.size();
        const auto parsed = std::from_chars(choice.data() + kind.size() + 1, end, threads);
        right = parsed.ec == std::errc() && parsed.ptr == end && threads >= 1 && threads <= mostThreads;
    }
    if (!right) {
        return fail(ErrorKind::Input, "device",
                    fmt::format("\"{}\" is neither cpu nor cpu:N (N threads, 1 to {}), nor the same with cpu-double",
                                choice, mostThreads));
    }
    const Precision precision = kind == "cpu" ? Precision::Single : Precision::Double;
    return std::make_unique<CpuDevice>(threads, precision, "asked for as " + choice);
}

}  // namespace spherule::compute::cpu
