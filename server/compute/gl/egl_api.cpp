#include "compute/gl/egl_api.h"

#include <array>
#include <mutex>
#include <utility>

#include <spdlog/fmt/fmt.h>

namespace spherule::compute::gl {

Result<void> loadEgl() {
    static const bool loaded = gladLoaderLoadEGL(EGL_NO_DISPLAY) != 0;
    if (loaded) return {};
    return fail(ErrorKind::NoDevice, "libEGL.so.1", "cannot be opened; install it (on Debian: apt install libegl1)");
}

std::string clientExtensions() {
    const char* const text = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (text == nullptr) eglGetError();
    return text == nullptr ? std::string() : text;
}

bool hasExtension(std::string_view extensions, std::string_view name) {
    for (std::size_t at = extensions.find(name); at != std::string_view::npos; at = extensions.find(name, at + 1)) {
        const auto end = at + name.size();
        const bool begins = at == 0 || extensions[at - 1] == ' ';
        if (begins && (end == extensions.size() || extensions[end] == ' ')) return true;
    }
    return false;
}

std::string eglErrorName(EGLint code) {
    constexpr std::array names{
        std::pair{EGL_SUCCESS, "EGL_SUCCESS"},
        std::pair{EGL_NOT_INITIALIZED, "EGL_NOT_INITIALIZED"},
        std::pair{EGL_BAD_ACCESS, "EGL_BAD_ACCESS"},
        std::pair{EGL_BAD_ALLOC, "EGL_BAD_ALLOC"},
        std::pair{EGL_BAD_ATTRIBUTE, "EGL_BAD_ATTRIBUTE"},
        std::pair{EGL_BAD_CONFIG, "EGL_BAD_CONFIG"},
        std::pair{EGL_BAD_CONTEXT, "EGL_BAD_CONTEXT"},
        std::pair{EGL_BAD_DISPLAY, "EGL_BAD_DISPLAY"},
        std::pair{EGL_BAD_MATCH, "EGL_BAD_MATCH"},
        std::pair{EGL_BAD_PARAMETER, "EGL_BAD_PARAMETER"},
        std::pair{EGL_CONTEXT_LOST, "EGL_CONTEXT_LOST"},
    };
    for (const auto& [known, name] : names) {
        if (known == code) return name;
    }
    return fmt::format("EGL error 0x{:x}", code);
}

void loadDisplayFunctions(EGLDisplay display) {
    static std::once_flag once;
    std::call_once(once, [display] { gladLoaderLoadEGL(display); });
}

}  // namespace spherule::compute::gl
