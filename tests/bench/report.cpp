#include "report.h"

#include <spdlog/fmt/chrono.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <thread>

namespace spherule::bench {

namespace {

std::string quoted(std::string text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    for (std::size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at + 2)) text.insert(at, 1, '"');
    return '"' + text + '"';
}

std::string padded(const Table& table) {
    std::vector<std::size_t> widths;
    for (const auto& row : table.rows) {
        widths.resize(std::max(widths.size(), row.size()));
        for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], row[k].size());
    }
    std::string text;
    for (const auto& row : table.rows) {
        text += fmt::format("  {:<{}}", row.front(), widths.front());
        for (std::size_t k = 1; k < row.size(); ++k) text += fmt::format("  {:>{}}", row[k], widths[k]);
        text += '\n';
    }
    return text;
}

}  // namespace

std::vector<std::string> headerFor(const compute::DeviceInfo& info, const std::string& command) {
    std::array<double, 3> load{};
    if (getloadavg(load.data(), 3) < 1) load[0] = -1;
    return {
        fmt::format("Date: {:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr))),
        fmt::format("Renderer: {} ({})", info.renderer, info.version),
        fmt::format("Machine: {} processors, load average {:.1f} when the figures were complete",
                    std::thread::hardware_concurrency(), load[0]),
        fmt::format("Command: {}", command),
    };
}

std::string textOf(const std::vector<std::string>& header, const Figures& figures) {
    std::string text;
    for (const std::string& line : header) text += line + '\n';
    for (const Table& table : tablesOf(figures)) {
        text += fmt::format("\n{}\n{}", table.name, padded(table));
        for (const std::string& note : table.notes) text += fmt::format("  {}\n", note);
    }
    return text;
}

std::string markdownOf(const std::vector<std::string>& header, const Figures& figures) {
    std::string text;
    for (const std::string& line : header) text += fmt::format("- {}\n", line);
    for (const Table& table : tablesOf(figures)) {
        text += fmt::format("\n### {}\n\n", table.name);
        bool head = true;
        for (const auto& row : table.rows) {
            text += fmt::format("| {} |\n", fmt::join(row, " | "));
            if (!std::exchange(head, false)) continue;
            text += "|---|";
            for (std::size_t k = 1; k < row.size(); ++k) text += "--:|";
            text += '\n';
        }
        if (!table.notes.empty()) text += '\n';
        for (const std::string& note : table.notes) text += fmt::format("- {}\n", note);
    }
    return text;
}

std::string csvOf(const std::vector<std::string>& header, const Figures& figures) {
    std::string text;
    for (const std::string& line : header) text += fmt::format("# {}\n", line);
    text += "table,spheres,what,value,unit,note\n";
    for (const Figure& figure : figures) {
        text += fmt::format("{},{},{},{},{},{}\n", quoted(figure.table), figure.spheres, quoted(figure.what),
                            figure.value ? fmt::format("{:.6g}", *figure.value) : "", quoted(figure.unit),
                            quoted(figure.note));
    }
    return text;
}

Result<void> writeFile(const std::string& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    if (file) return {};
    return fail(ErrorKind::Input, path, fmt::format("cannot be written: {}", std::strerror(errno)));
}

}  // namespace spherule::bench
