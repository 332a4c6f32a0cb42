#include "app/secret_files.h"

#include <cstdlib>
#include <fstream>

#include "net/admission.h"

namespace spherule::app {

namespace {

constexpr std::size_t longestFile = std::size_t{1} << 20U;

}  // namespace

Result<std::string> contentOf(const std::string& option, const std::string& path) {
    if (path.empty()) return std::string();
    std::ifstream file(path, std::ios::binary);
    std::string text(longestFile + 1, '\0');  // never more: it may be a device that has no end
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(file.gcount()));
    if (!file.good() && !file.eof()) return fail(ErrorKind::Input, option, path + " cannot be read");
    if (text.empty()) return fail(ErrorKind::Input, option, path + " is empty, or cannot be read");
    if (text.size() > longestFile) return fail(ErrorKind::Input, option, path + " is longer than 1 MiB");
    return text;
}

Result<std::string> tokenOf(const std::string& option, const std::string& path, const char* variable) {
    const char* const given = std::getenv(variable);
    std::string token = given == nullptr ? "" : given;
    if (!path.empty()) {
        if (!token.empty()) return fail(ErrorKind::Input, option, std::string("is given, and so is ") + variable);
        auto content = contentOf(option, path);
        if (!content) return content;
        token = std::move(*content);
        // Editors and echo end a file with a new line.
        while (!token.empty() && (token.back() == '\n' || token.back() == '\r')) token.pop_back();
    }
    if (token.empty() && path.empty()) return token;
    if (auto good = net::checkToken(token, path.empty() ? variable : option); !good)
        return tl::unexpected(good.error());
    return token;
}

}  // namespace spherule::app
