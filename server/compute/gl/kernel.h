#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "compute/device.h"
#include "compute/gl/context.h"
#include "compute/source.h"

namespace spherule::compute::gl {

// A compiled compute program and its bindings.
class GlKernel final : public Kernel {
  public:
    struct Slot {
        GLuint binding = 0;
        std::string block;
    };

    // Input, with the compiler's messages, if the kernel does not compile or violates the rules of
    // Device::createKernel.
    static Result<std::unique_ptr<Kernel>> create(const std::shared_ptr<Context>& context, const SourceSet& sources,
                                                  std::string_view file, std::span<const Define> defines);
    ~GlKernel() override;
    GlKernel(const GlKernel&) = delete;
    GlKernel& operator=(const GlKernel&) = delete;

    [[nodiscard]] const std::string& name() const override { return name_; }
    [[nodiscard]] std::span<const BufferDeclaration> buffers() const override { return buffers_; }
    [[nodiscard]] GLuint program() const { return program_; }
    [[nodiscard]] const std::vector<Slot>& slots() const { return slots_; }
    [[nodiscard]] bool wantsParameters() const { return wantsParameters_; }
    // Returns the number of work groups of a launch of `count`: see Launch.
    [[nodiscard]] std::uint32_t groupsOf(std::uint32_t count) const {
        return countsGroups_ ? count : count / groupSize_ + (count % groupSize_ != 0 ? 1 : 0);
    }

    // Sets `phase` and `invocations` if the kernel uses them.
    void setUniforms(std::uint32_t phase, std::uint32_t invocations) const;

  private:
    // A uniform that the compiler may have removed (location -1).
    class Uniform {
      public:
        void find(GLuint program, const char* name);
        void set(GLuint program, std::uint32_t value);

      private:
        GLint location_ = -1;
        std::uint32_t value_ = 0;  // GL's initial value
    };

    GlKernel(std::shared_ptr<Context> context, std::string name);
    Result<void> build(const std::string& text, std::span<const std::string> files);
    Result<void> reflect();
    Result<void> reflectSlots();

    std::shared_ptr<Context> context_;
    std::string name_;
    std::vector<ExpandedSource::Buffer> declared_;
    std::vector<BufferDeclaration> buffers_;  // views of declared_
    GLuint program_ = 0;
    std::vector<Slot> slots_;
    bool wantsParameters_ = false;
    bool countsGroups_ = false;
    std::uint32_t groupSize_ = 0;          // invocations
    mutable Uniform phase_, invocations_;  // with the values that GL holds, to skip redundant calls
};

}  // namespace spherule::compute::gl
