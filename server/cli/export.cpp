#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "checkpoint/folder.h"
#include "cli/errors.h"
#include "cli/exit_codes.h"
#include "cli/interrupt.h"
#include "cli/option_values.h"
#include "cli/options.h"
#include "cli/progress_line.h"
#include "codec/order.h"
#include "compute/device.h"
#include "core/log.h"
#include "host/facts_message.h"
#include "host/to_proto.h"
#include "recording/exporter.h"
#include "recording/recording.h"
#include "recording/unwrap.h"
#include "sim/simulation.h"

namespace spherule::cli {

namespace {

struct ExportOptions {
    std::string file;
    std::string format;
    std::string out;
    std::string every, from, to;
    bool replace = false;
    bool unwrap = false;
};

// Times in simulated seconds.
struct Range {
    double every = 0;  // 0: every frame
    double from = -std::numeric_limits<double>::infinity();
    double to = std::numeric_limits<double>::infinity();
};

constexpr double sameTime = 1e-6;  // tolerance (s): times are sums of steps

Result<Range> rangeOf(const ExportOptions& options) {
    Range range;
    const auto read = [](const std::string& text, const char* option, double& seconds) -> Result<void> {
        if (text.empty()) return {};
        const auto given = secondsOf(text, option);
        if (!given) return tl::unexpected(given.error());
        seconds = *given;
        return {};
    };
    if (auto done = read(options.every, "--every", range.every); !done) return tl::unexpected(done.error());
    if (auto done = read(options.from, "--from", range.from); !done) return tl::unexpected(done.error());
    if (auto done = read(options.to, "--to", range.to); !done) return tl::unexpected(done.error());
    if (!options.every.empty() && !(range.every > 0)) return fail(ErrorKind::Input, "--every", "must be above 0");
    if (range.to < range.from) return fail(ErrorKind::Input, "--to", "is before --from");
    return range;
}

recording::MadeExporter exporterFor(const ExportOptions& options) {
    if (options.format == "vtk" && options.out == "-")
        return fail(ErrorKind::Input, "--out",
                    "cannot be standard output: vtk is many files; give a name, or --format xyz");
    if (options.format == "xyz") return recording::xyzExporter(options.out, options.replace);
    if (options.format == "csv") return recording::csvExporter(options.out, options.replace);
    if (options.format == "poses") return recording::posesExporter(options.out, options.replace);
    return recording::vtkExporter(options.out, options.replace);
}

// Moves to the first frame that is not before `from`. Returns false if there is none, or when the export is
// interrupted.
Result<bool> enter(recording::Recording& recording, double from, const Interrupt& interrupt) {
    const auto readOn = [&]() -> Result<bool> {
        while (recording.time() < from - sameTime) {
            auto more = recording.next();
            if (!more || !*more) return more;
            if (interrupt.asked()) return false;
        }
        return true;
    };
    const auto sought = recording.seek(from);
    const Result<bool> entered = sought ? readOn() : tl::unexpected(sought.error());
    if (entered) return entered;
    // After damage, the next readable keyframe is the first usable frame.
    spdlog::warn("{}", entered.error().text());
    if (!recording.recover(from)) return entered;
    return readOn();
}

struct Written {
    std::uint64_t frames = 0;
    double error = 0;  // largest error of a coordinate (m)
};

// With `every`, writes the first frame at or after each multiple of it, counted from the first frame. After an
// interrupt it stops early and does not finish the export.
Result<Written> write(recording::Recording& recording, const Range& range, bool unwrap, recording::Exporter& exporter,
                      const Interrupt& interrupt) {
    Written written;
    ProgressLine progress;
    auto more = enter(recording, std::max(range.from, recording.begin()), interrupt);
    const double first = recording.time();
    double due = 0;
    std::optional<double> newest;
    recording::Unwrapper unwrapper;
    for (; more && *more && !interrupt.asked(); more = recording.next()) {
        const double time = recording.time();
        if (time > range.to + sameTime) break;
        // Spheres are followed through all frames, also those that are left out.
        recording::Snapshot snapshot;
        if (unwrap) {
            snapshot = recording.now();
            snapshot.positions = unwrapper.follow(snapshot);
        }
        // A recording of a reset or a pause may have several frames of the same time.
        if (newest && time <= *newest) continue;
        if (range.every > 0) {
            const double at = (time - first + sameTime) / range.every;
            if (at < due) continue;
            due = std::floor(at) + 1;
        }
        newest = time;
        if (!unwrap) snapshot = recording.now();
        if (auto done = exporter.add(snapshot); !done) return tl::unexpected(done.error());
        ++written.frames;
        written.error = std::max(written.error, snapshot.error);
        progress.show([&] {
            return fmt::format("{} frames, at {:.2f} s of {:.2f} s ", written.frames, time,
                               std::min(range.to, recording.end()));
        });
    }
    if (interrupt.asked()) return written;
    if (!more) {
        // The frames before the damage are valid, so the export is finished. The damage decides the exit code.
        if (auto done = exporter.finish(); !done) return tl::unexpected(done.error());
        return fail(ErrorKind::Input, "",
                    fmt::format("{}; {} frames before it were exported; --from exports the part after it",
                                more.error().text(), written.frames));
    }
    if (auto done = exporter.finish(); !done) return tl::unexpected(done.error());
    return written;
}

// Refuses to write over the file that is exported.
Result<void> checkOutput(const std::string& file, const std::string& out) {
    std::error_code missing;  // set if the output file does not exist yet
    if (std::filesystem::equivalent(file, out, missing))
        return fail(ErrorKind::Input, out, "is the exported file itself; choose another name");
    return {};
}

Result<void> exportRecording(const ExportOptions& options, Interrupt& interrupt) {
    const auto range = rangeOf(options);
    if (!range) return tl::unexpected(range.error());
    auto recording = recording::Recording::open(options.file);
    if (!recording) return tl::unexpected(recording.error());
    if (!recording->damage().empty())
        spdlog::warn("{} is exported up to {:g} s: {}", options.file, recording->end(), recording->damage());
    if (range->from > recording->end() + sameTime || range->to < recording->begin() - sameTime)
        return fail(ErrorKind::Input, options.file,
                    fmt::format("has nothing of that time: it goes from {:g} s to {:g} s", recording->begin(),
                                recording->end()));
    if (auto other = checkOutput(options.file, options.out); !other) return other;
    interrupt.finishFirst();
    auto exporter = exporterFor(options);
    if (!exporter) return tl::unexpected(exporter.error());
    const auto written = write(*recording, *range, options.unwrap, **exporter, interrupt);
    if (!written) return tl::unexpected(written.error());
    if (interrupt.asked()) {
        spdlog::warn("ended by {} after {} frames: {} was not written", interrupt.name(), written->frames,
                     (*exporter)->path());
        return {};
    }
    spdlog::info(
        "exported {} frames to {}; positions are within {:.3g} m of the simulation's on each axis; recordings "
        "have no velocities, spins, sleep or contacts: spherule run --dump writes these",
        written->frames, (*exporter)->path(), written->error);
    return {};
}

// Writes the state of a checkpoint as one frame. Its positions are exact.
Result<void> exportCheckpoint(const ExportOptions& options) {
    if (!options.every.empty() || !options.from.empty() || !options.to.empty() || options.unwrap)
        return fail(ErrorKind::Input, options.file,
                    "is a checkpoint, with one state: leave out --every, --from, --to and --unwrap");
    const auto path = checkpoint::newestIn(options.file);
    if (!path) return tl::unexpected(path.error());
    if (auto other = checkOutput(*path, options.out); !other) return other;
    const auto world = checkpoint::readCheckpoint(*path);
    if (!world) return tl::unexpected(world.error());
    auto device = compute::openDevice("cpu:1");
    if (!device) return tl::unexpected(device.error());
    const auto simulation = sim::Simulation::restore(**device, world->state);
    if (!simulation) {
        Error error = simulation.error();
        error.where = *path;
        return tl::unexpected(std::move(error));
    }
    const scene::Scene& scene = (*simulation)->scene();
    const sim::State state = (*simulation)->snapshot();
    if (state.count() == 0) return fail(ErrorKind::Input, *path, "has no spheres");

    const v1::ServerMessage facts = host::factsMessage(**simulation, 1);
    std::vector<std::uint32_t> order(state.count());
    std::iota(order.begin(), order.end(), 0U);
    const auto table = recording::SphereTable::from(facts.scene(), codec::orderMessage(1, 1, order));
    if (!table) return fail(ErrorKind::Input, *path, table.error().message);
    std::vector<glm::dvec3> positions;
    for (std::uint32_t rank = 0; rank < state.count(); ++rank)
        positions.push_back(sim::positionOf(state, rank) + scene.bounds.centre());
    v1::Frame poses;
    host::setPoses(poses, scene.obstacles, (*simulation)->time());

    auto exporter = exporterFor(options);
    if (!exporter) return tl::unexpected(exporter.error());
    const std::vector<v1::Pose> moved(poses.poses().begin(), poses.poses().end());
    if (auto done = (*exporter)->add({.time = (*simulation)->time(),
                                      .step = (*simulation)->steps(),
                                      .positions = positions,
                                      .spheres = &*table,
                                      .scene = 1,
                                      .facts = &facts.scene(),
                                      .poses = moved});
        !done)
        return done;
    if (auto done = (*exporter)->finish(); !done) return done;
    spdlog::info("exported the state of {}, at {:g} s, to {}", *path, (*simulation)->time(), (*exporter)->path());
    return {};
}

}  // namespace

void addExport(CLI::App& app, int& exitCode) {
    auto options = std::make_shared<ExportOptions>();
    CLI::App* command = app.add_subcommand("export", "convert a recording or a checkpoint for other tools");
    command
        ->add_option("file", options->file, "the recording, the checkpoint, or a folder of checkpoints: the newest one")
        ->required();
    command
        ->add_option("--format", options->format,
                     "xyz (OVITO, ASE), vtk (ParaView), csv, or poses (CSV of the obstacles that move)")
        ->required()
        ->check(CLI::IsMember({"xyz", "vtk", "csv", "poses"}));
    command
        ->add_option("--out", options->out,
                     "output file, or - for standard output; for vtk the .pvd file, beside a folder of that name")
        ->required();
    command->add_option("--every", options->every, "interval between frames, such as 0.1s [every frame]");
    command->add_option("--from", options->from, "simulated time of the first frame, such as 1.5s");
    command->add_option("--to", options->to, "simulated time of the last frame");
    command->add_flag("--unwrap", options->unwrap,
                      "follow spheres across periodic axes, so that positions never jump; give the frames often enough "
                      "that none moves by half a length in between");
    command->add_flag("--force", options->replace, "replace existing files");
    command->footer(exitCodesText);
    command->callback([options, &exitCode] {
        Interrupt interrupt;
        const auto done =
            checkpoint::isCheckpoint(options->file) ? exportCheckpoint(*options) : exportRecording(*options, interrupt);
        if (!done)
            exitCode = printError(done.error());
        else
            exitCode = interrupt.asked() ? exitBySignal + interrupt.signal() : exitDone;
    });
}

}  // namespace spherule::cli
