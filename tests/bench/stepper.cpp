#include <spdlog/fmt/fmt.h>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <span>
#include <sstream>

#include "compute/device.h"
#include "scene/load.h"
#include "sim/simulation.h"

// Runs a scene without sleep on a device, as commands on standard input ask:
//
//     spherule_stepper SCENE.json DEVICE
//
//     start         places the spheres as the scene does
//     run SUBSTEPS  reports the time that they take
//     load FILE     places the spheres as in a state that was saved
//     save FILE
//     state         reports statistics and the hash of the state
//
// Each answer is one line of JSON. beside.py drives the programs of two commits in turn. It also compiles this file
// against the libraries of the older commit, so this file uses only few interfaces of server/.

namespace {

using namespace spherule;

double processorSeconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);  // of all threads
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

class Stepper {
  public:
    Stepper(compute::Device& device, std::unique_ptr<sim::Simulation> simulation)
        : device_(device), simulation_(std::move(simulation)) {}

    // Returns the answer to a line.
    Result<std::string> answer(const std::string& line) {
        std::istringstream words(line);
        std::string command;
        std::string argument;
        words >> command >> argument;
        if (command == "start") return upload(sim::stateOf(simulation_->scene()));
        if (command == "run") return run(std::stoul(argument));
        if (command == "load") return load(argument);
        if (command == "save") return save(argument);
        if (command == "state") return state();
        return fail(ErrorKind::Input, line, "is not a command");
    }

  private:
    Result<std::string> run(unsigned long substeps) {
        device_.finish();
        const double timeBefore = simulation_->time();
        const double processorBefore = processorSeconds();
        const auto before = std::chrono::steady_clock::now();
        for (unsigned long k = 0; k < substeps; ++k)
            if (auto done = simulation_->advance(); !done) return tl::unexpected(done.error());
        device_.finish();
        const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - before;
        const double processor = processorSeconds() - processorBefore;
        return fmt::format(R"({{"substeps": {}, "simulated": {}, "wall": {}, "processor": {}}})", substeps,
                           simulation_->time() - timeBefore, wall.count(), processor);
    }

    Result<std::string> upload(const sim::State& state) {
        simulation_->upload(state);
        return "{}";
    }

    Result<std::string> load(const std::string& path) {
        sim::State state = sim::stateOf(simulation_->scene());
        std::ifstream file(path, std::ios::binary);
        for (auto* column : {&state.position, &state.velocity, &state.spin}) {
            const auto bytes = std::as_writable_bytes(std::span(*column));
            file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        }
        if (!file || file.peek() != std::ifstream::traits_type::eof())
            return fail(ErrorKind::Input, path, fmt::format("is not a state of {} spheres", state.count()));
        return upload(state);
    }

    Result<std::string> save(const std::string& path) {
        const sim::State state = simulation_->snapshot();
        std::ofstream file(path, std::ios::binary);
        for (const auto* column : {&state.position, &state.velocity, &state.spin}) {
            const auto bytes = std::as_bytes(std::span(*column));
            file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        }
        file.close();
        if (!file) return fail(ErrorKind::Input, path, "cannot be written");
        return "{}";
    }

    Result<std::string> state() {
        const sim::Statistics now = simulation_->statistics();
        const auto& counters = simulation_->counters();
        return fmt::format(
            R"({{"spheres": {}, "hash": "{:016x}", "overlapMean": {}, "overlapMax": {}, "wallOverlapMax": {}, )"
            R"("speedRms": {}, "speedMax": {}, "meanHeight": {}, "contacts": {}, "nonFinite": {}, "pairs": {}, )"
            R"("rebuilds": {}}})",
            now.spheres, sim::hashOf(simulation_->snapshot()), now.overlapMean, now.overlapMax, now.wallOverlapMax,
            now.speedRms, now.speedMax, now.meanHeight, now.contacts, now.nonFinite, counters.pairs, counters.rebuilds);
    }

    compute::Device& device_;
    std::unique_ptr<sim::Simulation> simulation_;
};

Result<void> serve(const std::string& scenePath, const std::string& deviceName) {
    auto device = compute::openDevice(deviceName);
    if (!device) return tl::unexpected(device.error());
    auto scene = scene::load(scenePath, (*device)->info().kind, {.noSleep = true});
    if (!scene) return tl::unexpected(scene.error());
    auto simulation = sim::Simulation::create(**device, std::move(*scene));
    if (!simulation) return tl::unexpected(simulation.error());
    Stepper stepper(**device, std::move(*simulation));
    for (std::string line; std::getline(std::cin, line);) {
        const auto answer = stepper.answer(line);
        if (!answer) return tl::unexpected(answer.error());
        fmt::print("{}\n", *answer);
        std::fflush(stdout);
    }
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        fmt::print(stderr, "usage: spherule_stepper SCENE.json DEVICE\n");
        return 1;
    }
    if (auto done = serve(argv[1], argv[2]); !done) {
        fmt::print(stderr, "spherule_stepper: {}\n", done.error().text());
        return 1;
    }
    return 0;
}
