#pragma once

#include <functional>
#include <string>
#include <vector>

#include "compute/device.h"
#include "measure/figure.h"

namespace spherule::measure {

struct Options {
    std::string suite = "all";  // or "accuracy", "cost", "stability"
    bool quick = false;
};

struct Report {
    std::string command;
    compute::DeviceInfo device;
    std::vector<Outcome> outcomes;
};

// Tells what is about to run.
using Progress = std::function<void(const std::string& what)>;

// Runs every case of the suite at every model and rung that it wants. Fails only when the device is lost: what a case
// cannot do is published with it.
Result<Report> measure(compute::Device& device, const Options& options, const Progress& progress);

// Model and factor, such as "balanced x2".
std::string nameOf(const Rung& rung);

// The files of a report.
std::string csvOf(const Report& report);       // a row per figure
std::string markdownOf(const Report& report);  // tables to read
std::string jsonOf(const Report& report);      // per model and rung: errors, cost; and all verdicts

// Error against cost of one work-precision curve, a line per model.
struct Plot {
    std::string name;  // of the curve, and of the file with '-' for ' '
    std::string svg;
};
std::vector<Plot> plotsOf(const Report& report);

// Writes all of them into `folder`, which is made where it is missing. Input for a folder that cannot be written.
Result<void> checkFolder(const std::string& folder);
Result<void> write(const Report& report, const std::string& folder);

}  // namespace spherule::measure
