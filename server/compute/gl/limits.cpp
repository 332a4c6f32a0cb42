#include "compute/gl/limits.h"

#include <string_view>

#include <glad/gl.h>

namespace spherule::compute::gl {
namespace {

std::int64_t integer(GLenum name) {
    GLint64 value = 0;
    glGetInteger64v(name, &value);
    return value;
}

std::int64_t integer(GLenum name, GLuint index) {
    GLint64 value = 0;
    glGetInteger64i_v(name, index, &value);
    return value;
}

bool hasGlExtension(std::string_view wanted) {
    const auto count = static_cast<GLuint>(integer(GL_NUM_EXTENSIONS));
    for (GLuint i = 0; i < count; ++i) {
        if (wanted == reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, i))) return true;
    }
    return false;
}

}  // namespace

Limits queryLimits() {
    return Limits{
        .maxBufferBytes = integer(GL_MAX_SHADER_STORAGE_BLOCK_SIZE),
        .storageBuffersPerKernel = integer(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS),
        .storageBindings = integer(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS),
        .uniformBlockBytes = integer(GL_MAX_UNIFORM_BLOCK_SIZE),
        .groupsX = integer(GL_MAX_COMPUTE_WORK_GROUP_COUNT, 0),
        .groupsY = integer(GL_MAX_COMPUTE_WORK_GROUP_COUNT, 1),
        .groupInvocations = integer(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS),
        .sharedBytes = integer(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE),
        .subgroups = hasGlExtension("GL_KHR_shader_subgroup"),
    };
}

}  // namespace spherule::compute::gl
