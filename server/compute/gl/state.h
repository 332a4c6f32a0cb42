#pragma once

#include <array>
#include <cstddef>

#include <glad/gl.h>

#include "compute/device.h"

namespace spherule::compute::gl {

// Cached settings of a context, so that a launch changes only settings that differ from the previous launch. The
// context must be current in every call.
class State {
  public:
    void useProgram(GLuint program);
    void bindStorage(std::size_t slot, GLuint buffer);
    void bindUniforms(GLuint buffer);
    void bindArguments(GLuint buffer);

    // Call before a deletion, because GL may reuse deleted names.
    void forgetBuffer(GLuint buffer);
    void forgetProgram(GLuint program);

    // Orders launches, so that each sees the writes of earlier launches. Kernels write no uniform block. The barrier of
    // the arguments of indirect launches costs up to 1.8 us on an H100. It is issued before the next indirect launch,
    // and only if a launch had their buffer at a slot, or if the buffer is another one.
    void afterLaunch();
    // Makes the launch wait for the copies before it: see afterCopy().
    void beforeLaunch();
    // Makes the writes of launches visible to copies, fills and uploads, which then wait until the launches are done.
    void beforeCopy();
    // Call after a copy, because the next launch may write what it reads.
    void afterCopy();

  private:
    GLuint program_ = 0;
    GLuint uniforms_ = 0;
    GLuint arguments_ = 0;
    std::array<GLuint, maxKernelBuffers> storage_{};
    bool launched_ = false;
    bool copied_ = false;
    bool argumentsBound_ = false;    // at a slot of the launch that is being prepared
    bool argumentsWritten_ = false;  // perhaps, since the last barrier
};

}  // namespace spherule::compute::gl
