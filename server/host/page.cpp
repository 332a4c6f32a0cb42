#include "host/page.h"

#include <fmt/format.h>
#include <openssl/sha.h>

#include <array>
#include <string_view>
#include <utility>

#include "embedded/page.h"

namespace spherule::host {

namespace {

constexpr std::string_view compressed = ".gz";

std::string_view typeOf(std::string_view name) {
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 5> types = {{
        {".html", "text/html; charset=utf-8"},
        {".js", "text/javascript; charset=utf-8"},
        {".css", "text/css; charset=utf-8"},
        {".svg", "image/svg+xml"},
        {".webp", "image/webp"},
    }};
    for (const auto& [suffix, type] : types)
        if (name.ends_with(suffix)) return type;
    return "application/octet-stream";
}

net::StaticFile::Form formOf(std::string_view bytes) {
    std::array<unsigned char, SHA256_DIGEST_LENGTH> hash{};
    SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), hash.data());
    // 128 bits suffice: the tag tells apart the versions of one file.
    return {bytes, fmt::format("\"{:02x}\"", fmt::join(hash.begin(), hash.begin() + 16, ""))};
}

}  // namespace

Page::Page() {
    std::map<std::string, net::StaticFile::Form> forms;
    for (const embedded::File& file : embedded::page()) forms.emplace(file.path, formOf(file.bytes));
    for (const auto& [name, form] : forms) {
        if (name.ends_with(compressed)) continue;
        files_["/" + name] = {std::string(typeOf(name)), form, forms.at(name + std::string(compressed))};
    }
}

const net::StaticFile* Page::find(const std::string& path) const {
    const auto found = files_.find(path == "/" ? "/index.html" : path);
    return found == files_.end() ? nullptr : &found->second;
}

}  // namespace spherule::host
