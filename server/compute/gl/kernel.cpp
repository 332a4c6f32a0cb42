#include "compute/gl/kernel.h"

#include <array>
#include <chrono>
#include <utility>
#include <vector>

#include <spdlog/fmt/fmt.h>

#include "core/log.h"

namespace spherule::compute::gl {
namespace {

// The threads of a PAIR_KERNEL. A batch of a dense bundle has about 300 pairs. On an H100, 256 threads take the least
// time.
constexpr const char* pairThreads = "256";
// llvmpipe runs eight threads of a work group at a time, and all vectors of threads that a group has, busy or not.
constexpr const char* softwareGroupThreads = "16";
constexpr const char* mesaLoopLimit = "65535u";  // LP_MAX_TGSI_LOOP_ITERATIONS of llvmpipe

std::string shaderLog(GLuint shader) {
    GLint length = 0;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string text(static_cast<std::size_t>(length), '\0');
    glGetShaderInfoLog(shader, length, &length, text.data());
    text.resize(static_cast<std::size_t>(length));
    return text;
}

std::string programLog(GLuint program) {
    GLint length = 0;
    glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
    std::string text(static_cast<std::size_t>(length), '\0');
    glGetProgramInfoLog(program, length, &length, text.data());
    text.resize(static_cast<std::size_t>(length));
    return text;
}

std::string blockName(GLuint program, GLuint index) {
    std::array<GLchar, 256> name{};
    GLsizei length = 0;
    glGetProgramResourceName(program, GL_SHADER_STORAGE_BLOCK, index, static_cast<GLsizei>(name.size()), &length,
                             name.data());
    return {name.data(), static_cast<std::size_t>(length)};
}

GLint activeCount(GLuint program, GLenum interface) {
    GLint count = 0;
    glGetProgramInterfaceiv(program, interface, GL_ACTIVE_RESOURCES, &count);
    return count;
}

GLuint bindingOf(GLuint program, GLenum interface, GLuint index) {
    constexpr GLenum wanted = GL_BUFFER_BINDING;
    GLint binding = 0;
    glGetProgramResourceiv(program, interface, index, 1, &wanted, 1, nullptr, &binding);
    return static_cast<GLuint>(binding);
}

}  // namespace

Result<std::unique_ptr<Kernel>> GlKernel::create(const std::shared_ptr<Context>& context, const SourceSet& sources,
                                                 std::string_view file, std::span<const Define> defines) {
    context->use();
    std::vector<Define> all(defines.begin(), defines.end());
    if (context->software()) all.push_back({"LOOP_LIMIT", mesaLoopLimit});
    if (context->software()) all.push_back({"GROUP_THREADS", softwareGroupThreads});
    all.push_back({"PAIR_THREADS", context->software() ? softwareGroupThreads : pairThreads});
    auto source = expandSource(sources, file, all);
    if (!source) return tl::unexpected(source.error());
    std::unique_ptr<GlKernel> kernel(new GlKernel(context, std::string(file)));
    kernel->declared_ = std::move(source->buffers);
    kernel->countsGroups_ = source->countsGroups;
    for (const auto& [type, name] : kernel->declared_) kernel->buffers_.push_back({type, name});
    const auto begin = std::chrono::steady_clock::now();
    if (auto built = kernel->build(source->text, source->files); !built) return tl::unexpected(built.error());
    spdlog::debug("{}: compiled in {:.2f} s", file,
                  std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    if (auto reflected = kernel->reflect(); !reflected) return tl::unexpected(reflected.error());
    return kernel;
}

GlKernel::GlKernel(std::shared_ptr<Context> context, std::string name)
    : context_(std::move(context)), name_(std::move(name)), program_(glCreateProgram()) {
    glObjectLabel(GL_PROGRAM, program_, static_cast<GLsizei>(name_.size()), name_.data());
}

GlKernel::~GlKernel() {
    context_->use();
    context_->state().forgetProgram(program_);
    glDeleteProgram(program_);
}

Result<void> GlKernel::build(const std::string& text, std::span<const std::string> files) {
    const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
    const GLchar* const begin = text.data();
    const auto length = static_cast<GLint>(text.size());
    glShaderSource(shader, 1, &begin, &length);
    glCompileShader(shader);
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    const std::string messages = nameFiles(shaderLog(shader), files);
    glAttachShader(program_, shader);
    glDeleteShader(shader);
    if (compiled == GL_FALSE) return fail(ErrorKind::Input, name_, "does not compile:\n" + messages);
    if (!messages.empty()) spdlog::debug("{}: {}", name_, messages);

    glLinkProgram(program_);
    GLint linked = GL_FALSE;
    glGetProgramiv(program_, GL_LINK_STATUS, &linked);
    if (linked == GL_FALSE)
        return fail(ErrorKind::Input, name_, "does not link:\n" + nameFiles(programLog(program_), files));
    return {};
}

Result<void> GlKernel::reflect() {
    std::array<GLint, 3> size{};
    glGetProgramiv(program_, GL_COMPUTE_WORK_GROUP_SIZE, size.data());
    if ((size[0] != 64 && size[0] != 1 && !countsGroups_) || size[1] != 1 || size[2] != 1) {
        return fail(ErrorKind::Input, name_,
                    fmt::format("has a local size of {} x {} x {}; kernels have 64 x 1 x 1, or 1 x 1 x 1", size[0],
                                size[1], size[2]));
    }
    groupSize_ = static_cast<std::uint32_t>(size[0]);
    phase_.find(program_, "phase");
    invocations_.find(program_, "invocations");

    const GLint blocks = activeCount(program_, GL_UNIFORM_BLOCK);
    wantsParameters_ = blocks > 0;
    if (blocks > 1 || (blocks == 1 && bindingOf(program_, GL_UNIFORM_BLOCK, 0) != 0)) {
        return fail(ErrorKind::Input, name_, "has a uniform block elsewhere than at binding 0; parameters go there");
    }
    return reflectSlots();
}

Result<void> GlKernel::reflectSlots() {
    const auto blocks = static_cast<GLuint>(activeCount(program_, GL_SHADER_STORAGE_BLOCK));
    for (GLuint index = 0; index < blocks; ++index) {
        Slot slot{bindingOf(program_, GL_SHADER_STORAGE_BLOCK, index), blockName(program_, index)};
        if (slot.binding >= maxKernelBuffers) {
            return fail(ErrorKind::Input, name_,
                        fmt::format("has buffer {} at slot {}; slots end at {}", slot.block, slot.binding,
                                    maxKernelBuffers - 1));
        }
        for (const auto& other : slots_) {
            if (other.binding == slot.binding) {
                return fail(ErrorKind::Input, name_,
                            fmt::format("has buffers {} and {} at slot {}", other.block, slot.block, slot.binding));
            }
        }
        slots_.push_back(std::move(slot));
    }
    return {};
}

void GlKernel::setUniforms(std::uint32_t phase, std::uint32_t invocations) const {
    phase_.set(program_, phase);
    invocations_.set(program_, invocations);
}

void GlKernel::Uniform::find(GLuint program, const char* name) {
    location_ = glGetUniformLocation(program, name);
}

void GlKernel::Uniform::set(GLuint program, std::uint32_t value) {
    if (location_ < 0 || std::exchange(value_, value) == value) return;
    glProgramUniform1ui(program, location_, value);
}

}  // namespace spherule::compute::gl
