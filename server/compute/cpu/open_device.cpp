#include <algorithm>
#include <charconv>
#include <system_error>

#include <spdlog/fmt/fmt.h>

#include "compute/cpu/device.h"
#include "compute/cpu/host.h"

namespace spherule::compute::cpu {
namespace {

constexpr unsigned mostThreads = 256;

// Reads ":N" or ":NxL" behind the kind of the device. Returns false if there is anything else.
bool readNumbers(const std::string& choice, std::size_t from, Precision precision, unsigned& threads, unsigned& lanes) {
    if (choice == "auto" || choice.size() == from) return true;
    const char* const end = choice.data() + choice.size();
    auto parsed = std::from_chars(choice.data() + from + 1, end, threads);
    if (parsed.ec != std::errc() || threads < 1 || threads > mostThreads) return false;
    if (parsed.ptr == end) return true;
    if (*parsed.ptr != 'x' || precision == Precision::Double) return false;
    unsigned wanted = 0;
    parsed = std::from_chars(parsed.ptr + 1, end, wanted);
    if (parsed.ec != std::errc() || parsed.ptr != end) return false;
    if (wanted != 1 && wanted != 4 && wanted != 8 && wanted != 16) return false;
    lanes = std::min(lanes, wanted);
    return true;
}

}  // namespace

bool answersTo(const std::string& choice) {
    return choice == "auto" || choice.starts_with("cpu");
}

Result<std::unique_ptr<Device>> openDevice(const std::string& choice, const std::string& passedOver) {
    const std::string kind = choice == "auto" ? "cpu" : choice.substr(0, choice.find(':'));
    const Precision precision = kind == "cpu-double" ? Precision::Double : Precision::Single;
    unsigned threads = std::min(processors(), mostThreads);
    unsigned lanes = precision == Precision::Double ? 1 : mostLanes();
    if (!(kind == "cpu" || kind == "cpu-double") || !readNumbers(choice, kind.size(), precision, threads, lanes)) {
        return fail(
            ErrorKind::Input, "--device",
            fmt::format("\"{}\" is neither cpu, nor cpu:N (N threads, 1 to {}), nor cpu:NxL (L lanes: 1, 4, 8 or "
                        "16), nor cpu-double, nor cpu-double:N",
                        choice, mostThreads));
    }
    try {
        return std::make_unique<CpuDevice>(threads, precision, lanes,
                                           choice == "auto" ? passedOver : "asked for as " + choice);
    } catch (const std::system_error& error) {
        return fail(ErrorKind::NoDevice, choice,
                    fmt::format("cannot start {} threads: {}; use --device cpu:N with fewer", threads, error.what()));
    }
}

}  // namespace spherule::compute::cpu
