#include <spdlog/fmt/fmt.h>
#include <CLI/CLI.hpp>

#include <cstdio>

#include "compare.h"
#include "costs.h"
#include "ladder.h"
#include "report.h"

// Compares broad phases on one device, and measures the passes of the simulation for several numbers of spheres.

namespace {

using namespace spherule;
using Sizes = std::vector<std::uint32_t>;

struct Options {
    std::string device = "software";
    Sizes sizes = {2000, 10000, 50000, 100000};
    Sizes ladder = {10000, 50000, 200000, 1000000};
    std::string csv;
    std::string markdown;
    bool friction = false;
    bool costs = false;
    bool quick = false;
};

void declare(CLI::App& app, Options& options) {
    app.add_option("--device", options.device,
                   "gpu, gpu:N or software; without comparison (--sizes 0) also cpu or cpu:THREADS")
        ->capture_default_str();
    app.add_option("--sizes", options.sizes, "spheres, at which all methods are compared; 0: not at all")
        ->delimiter(',')
        ->capture_default_str();
    app.add_option("--ladder", options.ladder, "spheres, at which our passes are timed; 0: not at all")
        ->delimiter(',')
        ->capture_default_str();
    app.add_flag("--friction", options.friction, "with friction, in our passes");
    app.add_flag("--costs", options.costs, "also the costs of launches and copies; not on cpu");
    app.add_option("--csv", options.csv, "file to write, one line per figure");
    app.add_option("--markdown", options.markdown, "file to write, as tables");
    app.add_flag("--quick", options.quick, "few spheres and short rounds: shows that it works, measures nothing");
}

Result<bench::Figures> measure(compute::Device& device, const Options& options) {
    bench::Figures figures;
    bench::Moments moments;
    bench::Effort effort;
    Sizes sizes = options.sizes;
    Sizes ladder = options.ladder;
    std::erase(sizes, 0U);
    std::erase(ladder, 0U);
    if (options.quick) {
        moments = {.falling = 0.1, .settled = 0.2};
        effort = {.rounds = 2, .roundSeconds = 0.01};
        if (!sizes.empty()) sizes = {500, 1000};
        if (!ladder.empty()) ladder = {500, 2000};
    }
    if (options.costs)
        if (auto done = bench::deviceCosts(device, options.quick, figures); !done) return tl::unexpected(done.error());
    for (const std::uint32_t size : sizes)
        if (auto done = bench::compare(device, size, moments, effort, figures); !done)
            return tl::unexpected(done.error());
    if (!ladder.empty())
        if (auto done = bench::climb(device, ladder, options.friction ? 0.4 : 0, options.quick ? 1 : 12, figures);
            !done)
            return tl::unexpected(done.error());
    return figures;
}

Result<void> run(const Options& options, const std::string& command) {
    auto device = compute::openDevice(options.device);
    if (!device) return tl::unexpected(device.error());
    auto figures = measure(**device, options);
    if (!figures) return tl::unexpected(figures.error());
    auto header = bench::headerFor((*device)->info(), command);
    if (const std::string spread = bench::spreadOf(*figures); !spread.empty()) header.push_back(spread);
    std::fputs(bench::textOf(header, *figures).c_str(), stdout);
    if (!options.markdown.empty())
        if (auto done = bench::writeFile(options.markdown, bench::markdownOf(header, *figures)); !done) return done;
    if (!options.csv.empty()) return bench::writeFile(options.csv, bench::csvOf(header, *figures));
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Broad phases against each other, and the passes of a substep over sizes"};
    Options options;
    declare(app, options);
    CLI11_PARSE(app, argc, argv);
    std::string command = "spherule_bench";
    for (int k = 1; k < argc; ++k) command.append(" ").append(argv[k]);
    if (auto done = run(options, command); !done) {
        fmt::print(stderr, "spherule_bench: {}\n", done.error().text());
        return 1;
    }
    return 0;
}
