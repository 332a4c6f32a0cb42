#include "compute/gl/state.h"

#include <utility>

namespace spherule::compute::gl {

void State::useProgram(GLuint program) {
    if (std::exchange(program_, program) != program) glUseProgram(program);
}

void State::bindStorage(std::size_t slot, GLuint buffer) {
    if (buffer == arguments_) argumentsBound_ = true;
    if (std::exchange(storage_[slot], buffer) != buffer) {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(slot), buffer);
    }
}

void State::bindUniforms(GLuint buffer) {
    if (std::exchange(uniforms_, buffer) != buffer) glBindBufferBase(GL_UNIFORM_BUFFER, 0, buffer);
}

void State::bindArguments(GLuint buffer) {
    if (std::exchange(arguments_, buffer) != buffer) {
        glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, buffer);
        argumentsWritten_ = true;
    }
    if (std::exchange(argumentsWritten_, false)) glMemoryBarrier(GL_COMMAND_BARRIER_BIT);
}

void State::forgetBuffer(GLuint buffer) {
    for (auto& bound : storage_) {
        if (bound == buffer) bound = 0;
    }
    if (uniforms_ == buffer) uniforms_ = 0;
    if (arguments_ == buffer) arguments_ = 0;
}

void State::forgetProgram(GLuint program) {
    if (program_ == program) useProgram(0);
}

void State::afterLaunch() {
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    launched_ = true;
    if (std::exchange(argumentsBound_, false)) argumentsWritten_ = true;
}

void State::beforeCopy() {
    if (std::exchange(launched_, false)) glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
}

void State::afterCopy() {
    copied_ = true;
}

void State::beforeLaunch() {
    if (std::exchange(copied_, false)) glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

}  // namespace spherule::compute::gl
