#include "sim/layout.h"

#include <regex>
#include <stdexcept>

#include "sim/shaders.h"

namespace spherule::sim::layout {

namespace {

// Returns the value of a literal, or of a constant that the same file defines: `#define NAME 8u`. Returns 1 for an
// empty name.
std::size_t numberIn(const std::string& text, const std::string& name) {
    if (name.empty()) return 1;
    if (name.find_first_not_of("0123456789") == std::string::npos) return std::stoul(name);
    std::smatch found;
    if (!std::regex_search(text, found, std::regex("#define " + name + " ([0-9]+)u")))
        throw std::logic_error("there is no constant " + name);
    return std::stoul(found[1]);
}

}  // namespace

std::string wordsOf(std::string_view structName, std::string_view file) {
    const std::string text(shaders().find("shared/" + std::string(file)).value_or(""));
    const auto begin = text.find("struct " + std::string(structName) + " {");
    const auto end = text.find("\n};", begin);
    if (begin == std::string::npos || end == std::string::npos)
        throw std::logic_error("there is no struct " + std::string(structName) + " in " + std::string(file));
    const std::string body = text.substr(begin, end - begin);
    static const std::regex member(R"(\n    (vec4|uvec4|float|uint) \w+(?:\[(\w+)\])?;)");
    std::string words;
    for (std::sregex_iterator at(body.begin(), body.end(), member), last; at != last; ++at) {
        const std::string type = (*at)[1];
        const bool vector = type == "vec4" || type == "uvec4";
        if (vector && words.size() % 4 != 0)
            throw std::logic_error(std::string(structName) + " has a vector behind scalars that fill no vector");
        const char word = type == "vec4" || type == "float" ? 'r' : 'u';
        words.append((vector ? 4 : 1) * numberIn(text, (*at)[2]), word);
    }
    return words;
}

}  // namespace spherule::sim::layout
