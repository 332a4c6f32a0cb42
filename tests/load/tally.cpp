#include "tally.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spherule::load {

namespace {

constexpr std::size_t faultsKept = 5;

}  // namespace

void Tally::fault(std::string what) {
    ++faultCount;
    if (faults.size() < faultsKept) faults.push_back(std::move(what));
}

void Tally::operator+=(const Tally& other) {
    viewers += other.viewers;
    joins += other.joins;
    bytes += other.bytes;
    frames += other.frames;
    received += other.received;
    ages.insert(ages.end(), other.ages.begin(), other.ages.end());
    for (const auto& [how, times] : other.ends) ends[how] += times;
    for (const std::string& what : other.faults)
        if (faults.size() < faultsKept) faults.push_back(what);
    faultCount += other.faultCount;
}

double percentile(const std::vector<std::uint32_t>& sorted, double part) {
    if (sorted.empty()) return 0;
    const auto rank = static_cast<std::size_t>(std::ceil(part * static_cast<double>(sorted.size())));
    return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
}

}  // namespace spherule::load
