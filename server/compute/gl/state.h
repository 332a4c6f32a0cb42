#pragma once

#include <array>
#include <cstddef>

#include <glad/gl.h>

#include "compute/device.h"

namespace spherule::compute::gl {

// What a context is set to, so that a launch sets only what differs from the launch before. Its context is current in
// every call.
class State {
  public:
    void useProgram(GLuint program);
    void bindStorage(std::size_t slot, GLuint buffer);
    void bindUniforms(GLuint buffer);
    void bindArguments(GLuint buffer);

    // Deleted names may be given out again.
    void forgetBuffer(GLuint buffer);
    void forgetProgram(GLuint program);

    // Orders launches: each sees what those before it wrote.
    void afterLaunch();
    // Makes what launches wrote visible to copies, fills and uploads, and holds those back until the launches are done.
    void beforeCopy();

  private:
    GLuint program_ = 0;
    GLuint uniforms_ = 0;
    GLuint arguments_ = 0;
    std::array<GLuint, maxKernelBuffers> storage_{};
    bool launched_ = false;
};

}  // namespace spherule::compute::gl
