#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "work_groups.h"

// Launches with a planted fault, which an instrument must report.
namespace spherule::instruments {

// Launches a kernel of controls(). A buffer has 256 words, zero at first. Returns the last buffer.
std::vector<std::uint32_t> launchControl(std::string_view kernel);

// Returns inWorkGroups() with one fault. Valid until the next call.
std::span<const Entry> withoutCellOrder();   // leaves spheres in cells in the order of their arrival
std::span<const Entry> withBatchesJoined();  // the first two batches of each bundle are one
std::span<const Entry> withColoursJoined();  // solve_contacts.comp also solves the bundles of the next colour

}  // namespace spherule::instruments
