#pragma once

#include <string>
#include <string_view>

#include <glad/egl.h>

#include "core/result.h"

// The functions of EGL that need no display. Any thread.
namespace spherule::compute::gl {

// Opens libEGL once per process. NoDevice if the host has none.
Result<void> loadEgl();

// Returns the client extensions of EGL; empty if EGL reports none (EGL 1.4 without client extensions).
std::string clientExtensions();

// Returns true if `name` is one of the blank-separated words of `extensions`.
bool hasExtension(std::string_view extensions, std::string_view name);

// Returns the name of an error code, such as "EGL_BAD_ACCESS".
std::string eglErrorName(EGLint code);

// Loads the functions of EGL that glad loads only for an initialised display. `display` must be initialised.
void loadDisplayFunctions(EGLDisplay display);

}  // namespace spherule::compute::gl
