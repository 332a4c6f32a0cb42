#pragma once

#include <string>
#include <string_view>

#include <glad/egl.h>

#include "core/result.h"

// EGL as the host offers it before any display is open. Any thread.
namespace spherule::compute::gl {

// Opens libEGL once per process. NoDevice when the host has none.
Result<void> loadEgl();

// What EGL offers without a display; empty when it says nothing (EGL 1.4 without client extensions).
std::string clientExtensions();

// True when `name` is one of the blank-separated words of `extensions`.
bool hasExtension(std::string_view extensions, std::string_view name);

// "EGL_BAD_ACCESS" and so on.
std::string eglErrorName(EGLint code);

// The part of EGL that glad loads only when it knows an initialised display. `display` is initialised.
void loadDisplayFunctions(EGLDisplay display);

}  // namespace spherule::compute::gl
