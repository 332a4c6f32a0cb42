#include "cli/secret_files.h"

#include <cstdlib>

#include "core/input_file.h"
#include "net/admission.h"

namespace spherule::cli {

namespace {

constexpr std::size_t longestFile = std::size_t{1} << 20U;

}  // namespace

Result<std::string> contentOf(const std::string& option, const std::string& path) {
    if (path.empty()) return std::string();
    auto text = readFile(path, longestFile);
    if (!text) return fail(ErrorKind::Input, option, text.error().text());
    if (text->empty()) return fail(ErrorKind::Input, option, path + ": is empty");
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

}  // namespace spherule::cli
