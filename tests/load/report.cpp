#include "report.h"

#include <algorithm>
#include <vector>

#include <spdlog/fmt/fmt.h>

namespace spherule::load {

namespace {

using Rows = std::vector<std::vector<std::string>>;  // rows of equal length; the first is the header

std::string rowOf(const std::vector<std::string>& row, const std::vector<std::size_t>& widths, bool markdown) {
    if (markdown) return fmt::format("| {} |\n", fmt::join(row, " | "));
    std::string text = fmt::format("{:<{}}", row[0], widths[0]);
    for (std::size_t k = 1; k < row.size(); ++k) text += fmt::format("  {:>{}}", row[k], widths[k]);
    return text + "\n";
}

std::string tableOf(const Rows& rows, bool markdown) {
    std::vector<std::size_t> widths(rows.front().size());
    for (const auto& row : rows)
        for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], row[k].size());
    std::string text = rowOf(rows.front(), widths, markdown);
    if (markdown) {
        text += "|---|";
        for (std::size_t k = 1; k < widths.size(); ++k) text += "--:|";
        text += "\n";
    }
    for (std::size_t r = 1; r < rows.size(); ++r) text += rowOf(rows[r], widths, markdown);
    return text;
}

std::string milliseconds(const std::vector<std::uint32_t>& sorted, double part) {
    return sorted.empty() ? "-" : fmt::format("{:.1f}", percentile(sorted, part) / 1000);
}

std::vector<std::string> timesOf(std::string_view name, Tally tally, double seconds) {
    std::ranges::sort(tally.ages);
    const double viewers = static_cast<double>(tally.viewers);
    return {std::string(name),
            std::to_string(tally.viewers),
            fmt::format("{:.1f}", static_cast<double>(tally.frames) / seconds / viewers),
            fmt::format("{:.2f}", static_cast<double>(tally.bytes) / seconds / 1e6),
            milliseconds(tally.ages, 0.5),
            milliseconds(tally.ages, 0.9),
            milliseconds(tally.ages, 0.99),
            milliseconds(tally.ages, 1)};
}

std::vector<std::string> contentOf(std::string_view name, const Tally& tally) {
    const Received& received = tally.received;
    int ends = 0;
    for (const auto& [how, times] : tally.ends) ends += times;
    return {std::string(name),
            std::to_string(tally.joins),
            std::to_string(received.frames),
            std::to_string(received.keyframes),
            std::to_string(received.chains),
            std::to_string(received.losses),
            std::to_string(received.missed),
            std::to_string(received.hashes),
            std::to_string(ends),
            std::to_string(tally.faultCount)};
}

std::string serverTable(const ServerUsage& server, double seconds, bool markdown) {
    const auto largest = [&](auto value) { return *std::ranges::max_element(server.during, {}, value); };
    const Usage& first = server.during.front();
    const Usage& last = server.during.back();
    const auto mib = [](double value) { return fmt::format("{:.1f}", value); };
    const auto after = [&](auto text) { return server.after ? text(*server.after) : std::string("gone"); };
    const Rows rows = {{"server", "before", "first", "largest", "last", "all have left"},
                       {"resident, MiB", mib(server.before.residentMiB), mib(first.residentMiB),
                        mib(largest(&Usage::residentMiB).residentMiB), mib(last.residentMiB),
                        after([&](const Usage& usage) { return mib(usage.residentMiB); })},
                       {"descriptors", std::to_string(server.before.descriptors), std::to_string(first.descriptors),
                        std::to_string(largest(&Usage::descriptors).descriptors), std::to_string(last.descriptors),
                        after([](const Usage& usage) { return std::to_string(usage.descriptors); })}};
    return tableOf(rows, markdown) +
           fmt::format("\nServer: {:.2f} s of CPU in {:.1f} s.\n", last.cpuSeconds - first.cpuSeconds, seconds);
}

}  // namespace

std::string reportOf(const Outcome& outcome, bool markdown) {
    Rows times = {{"viewers", "N", "frames/s each", "MB/s all", "age p50, ms", "p90", "p99", "max"}};
    Rows content = {{"viewers", "joins", "frames", "keyframes", "chains begun", "losses", "frames missed",
                     "hashes compared", "ended by the server", "faults"}};
    std::string ends, faults;
    for (std::size_t kind = 0; kind < kindNames.size(); ++kind) {
        const Tally& tally = outcome.tallies[kind];
        if (tally.viewers == 0) continue;
        times.push_back(timesOf(kindNames[kind], tally, outcome.seconds));
        content.push_back(contentOf(kindNames[kind], tally));
        for (const auto& [how, number] : tally.ends)
            ends += fmt::format("- {}, {} times: {}\n", kindNames[kind], number, how);
        for (const std::string& fault : tally.faults) faults += fmt::format("- FAULT: {}\n", fault);
    }
    std::string text = fmt::format("{}\n{}", tableOf(times, markdown), tableOf(content, markdown));
    if (!ends.empty()) text += "\nSessions that the viewer did not end:\n\n" + ends;
    if (!faults.empty()) text += "\nThe first faults of each kind:\n\n" + faults;
    if (outcome.server && !outcome.server->during.empty())
        text += fmt::format("\n{}", serverTable(*outcome.server, outcome.seconds, markdown));
    return text + fmt::format("{}Load client: {:.2f} s of CPU in {:.1f} s.\n", outcome.server ? "" : "\n",
                              outcome.cpuSeconds, outcome.seconds);
}

}  // namespace spherule::load
