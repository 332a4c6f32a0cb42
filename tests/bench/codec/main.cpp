#include <spdlog/fmt/fmt.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <iterator>
#include <map>
#include <stdexcept>

#include "sizes.h"
#include "speed.h"
#include "trajectories.h"

// Measures the codec of docs/codec.md: its bytes per sphere, compared with other codecs, and its times.

namespace {

using namespace spherule;

struct Options {
    std::string device = "cpu";
    std::uint32_t spheres = 50'000;
    std::vector<double> ratios = {50, 500, 16};
    std::uint32_t speed = 1'000'000;
    double speedRatio = 50;
    std::string trajectories;
    std::string keep;
    std::string frames;
};

void declare(CLI::App& app, Options& options) {
    app.add_option("--device", options.device, "where the simulation and the encoder run")->capture_default_str();
    app.add_option("--spheres", options.spheres, "of the trajectories; 0: no sizes")->capture_default_str();
    app.add_option("--ratios", options.ratios, "the error is the smallest radius over this")
        ->delimiter(',')
        ->capture_default_str();
    app.add_option("--speed", options.speed, "spheres for the times; 0: no times")->capture_default_str();
    app.add_option("--speed-ratio", options.speedRatio, "as --ratios, for the times")->capture_default_str();
    app.add_option("--trajectories", options.trajectories,
                   "a file that --keep wrote, in place of the simulation; times are of its `moving`");
    app.add_option("--keep", options.keep, "file for the trajectories");
    app.add_option("--frames", options.frames, "folder for the frames that were timed, for tools/bench_codec.mjs");
}

// One row per codec, one column per trajectory.
void printTable(const std::vector<bench::CodecSize>& sizes, double ratio) {
    std::vector<std::string> codecs, trajectories;
    std::map<std::pair<std::string, std::string>, double> bytes;
    for (const auto& size : sizes) {
        if (std::ranges::find(codecs, size.codec) == codecs.end()) codecs.push_back(size.codec);
        if (std::ranges::find(trajectories, size.trajectory) == trajectories.end())
            trajectories.push_back(size.trajectory);
        bytes[{size.codec, size.trajectory}] = size.bytes;
    }
    fmt::print("\n| error r/{:g}: bytes per sphere and frame | {} |\n|---|", ratio, fmt::join(trajectories, " | "));
    for (std::size_t k = 0; k < trajectories.size(); ++k) fmt::print("--:|");
    fmt::print("\n");
    for (const std::string& codec : codecs) {
        fmt::print("| {} |", codec);
        for (const std::string& trajectory : trajectories) fmt::print(" {:.3f} |", bytes[{codec, trajectory}]);
        fmt::print("\n");
    }
}

void printSpeed(const Options& options, const std::string& what, const bench::CodecSpeed& speed) {
    fmt::print(
        "{} spheres, {}, {:.2f} bytes each: encode {:.1f} ms (fastest {:.1f} ms, {:.1f} million/s), keyframe {:.1f} "
        "ms, "
        "hash {:.1f} ms, decode {:.1f} ms\n",
        options.speed, what, speed.bytes, speed.encode, speed.fastest, options.speed / speed.fastest / 1000,
        speed.keyframe, speed.hash, speed.decode);
}

void measureSpeed(const Options& options, compute::Device& device) {
    if (options.trajectories.empty()) {
        for (const bool shuffled : {true, false})
            printSpeed(options, shuffled ? "kicked, ids shuffled" : "kicked, ids of a lattice",
                       bench::codecSpeed(device, options.speed, options.speedRatio, shuffled, options.frames));
        return;
    }
    for (const bench::Trajectory& bed : bench::load(options.trajectories))
        if (bed.name == "moving")
            printSpeed(options, "copies of `moving`",
                       bench::codecSpeed(device, options.speed, options.speedRatio, bed, options.frames));
}

void measure(const Options& options, compute::Device& device) {
    fmt::print("device: {}\n", device.info().renderer);
    if (options.speed > 0) measureSpeed(options, device);
    if (options.spheres == 0) return;
    const auto trajectories =
        options.trajectories.empty() ? bench::collapse(device, options.spheres) : bench::load(options.trajectories);
    if (!options.keep.empty()) bench::save(options.keep, trajectories);
    for (const double ratio : options.ratios) {
        std::vector<bench::CodecSize> sizes;
        for (const bench::Trajectory& trajectory : trajectories)
            std::ranges::move(bench::codecSizes(device, trajectory, ratio), std::back_inserter(sizes));
        printTable(sizes, ratio);
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("measures the codec");
    declare(app, options);
    CLI11_PARSE(app, argc, argv);
    try {
        const auto device = compute::openDevice(options.device);
        if (!device) throw std::runtime_error(device.error().text());
        measure(options, **device);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
    return 0;
}
