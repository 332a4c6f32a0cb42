#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/result.h"
#include "scene/scene.h"
#include "sim/commands.h"
#include "sim/simulation.h"
#include "spherule/v1/control.pb.h"

namespace spherule::cli {

// Timed commands for `spherule run`. A line of the file has a time, such as 1.5s, and a command in the words of
// `spherule ctl`. Allowed are set, spawn, remove, push, and changes of parts of the scene. A word that begins with { is
// JSON and reaches to the end of the line. Lines that are empty or begin with # are skipped. Times do not decrease from
// line to line. Errors have the file and the line.
class Script {
  public:
    // Input if a line is wrong.
    static Result<Script> read(const std::string& path);

    // Refuses a command that is certain to fail in a run of `duration` seconds that begins with `scene`. A setting, a
    // part of the scene or a group is wrong, a sphere does not exist, or no step follows. Other commands fail in the
    // run: those about spheres of emitters, and obstacles that spheres are in the way of.
    [[nodiscard]] Result<void> check(const scene::Scene& scene, double duration) const;

    // The lines with commands, as in the file.
    [[nodiscard]] const std::string& text() const { return text_; }

    // Carries out the commands that are due at the present step: those whose time is not after it. Calls
    // carriedOut() with the message of each after it. Returns true if there were any. Call it before each step.
    Result<bool> applyDue(sim::Simulation& simulation, const std::function<void(const v1::Command&)>& carriedOut);

    [[nodiscard]] std::size_t done() const { return next_; }  // commands that have been carried out
    // Goes on after so many commands. Input if the script has fewer.
    Result<void> goOnAfter(std::uint64_t commands);

  private:
    struct Line {
        std::string where;  // "FILE:LINE"
        double time = 0;    // s simulated
        std::string name;   // of the command
        v1::Command message;
        sim::Command command;
    };

    static Result<Line> parse(const std::string& where, const std::string& text);

    std::vector<Line> lines_;
    std::string text_;
    std::size_t next_ = 0;  // of lines_, the first that has not been carried out
};

}  // namespace spherule::cli
