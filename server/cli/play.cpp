#include <filesystem>

#include "cli/config_file.h"
#include "cli/exit_codes.h"
#include "cli/options.h"
#include "cli/serve_until_signal.h"
#include "core/heartbeat.h"
#include "core/log.h"
#include "host/playback_producer.h"

namespace spherule::cli {

namespace {

struct PlayOptions {
    std::string file;
    ServerOptions serving;
    double speed = 1;
    bool again = false;
    bool paused = false;
};

Result<host::Player> playerOf(const PlayOptions& options) {
    const heartbeat::Pause reading;
    auto recording = recording::Recording::open(options.file);
    if (!recording) return tl::unexpected(recording.error());
    if (!recording->damage().empty())
        spdlog::warn("{} is played up to {:g} s: {}", options.file, recording->end(), recording->damage());
    const auto now = host::Player::Clock::now();
    const std::string name = std::filesystem::path(options.file).filename().string();
    host::Player player(std::move(*recording), name, options.again, now);
    v1::Command speed;
    speed.mutable_set()->set_speed(options.speed);
    v1::Command pause;
    pause.mutable_pause();
    if (auto done = player.apply(speed, now); !done) return fail(ErrorKind::Input, "--speed", done.error().message);
    if (options.paused)
        if (auto done = player.apply(pause, now); !done) return tl::unexpected(done.error());
    return player;
}

// Uses the CPU device: the processor decodes the recording, so the positions are already in its memory.
Result<std::unique_ptr<host::FrameProducer>> open(const PlayOptions& options, const host::ProducerIo& io) {
    auto player = playerOf(options);
    if (!player) return tl::unexpected(player.error());
    auto device = compute::openDevice("cpu");
    if (!device) return tl::unexpected(device.error());
    io.board.update([&](host::ServerStatus& current) {
        current.device = (*device)->info();
        current.device.reason = "a recording needs no GPU";
        current.scene = player->recording().facts().name();
        current.spheres = player->recording().facts().count();
    });
    return std::make_unique<host::PlaybackProducer>(std::move(*device), std::move(*player), io);
}

}  // namespace

void addPlay(CLI::App& app, int& exitCode) {
    auto options = std::make_shared<PlayOptions>();
    CLI::App* command = app.add_subcommand("play", "show a recording in a browser");
    command->add_option("file", options->file, "the recording")->required();
    options->serving.addTo(*command);
    command->add_option("--speed", options->speed, "recorded seconds per second")->capture_default_str();
    command->add_flag("--loop", options->again, "begin again at the end");
    command->add_flag("--paused", options->paused, "start paused");
    command->footer(exitCodesText);
    addSettings(*command);
    command->callback([options, &exitCode] {
        exitCode = serveUntilSignal([&](const host::ProducerIo& io) { return open(*options, io); }, options->serving,
                                    "plays " + options->file + ":");
    });
}

}  // namespace spherule::cli
