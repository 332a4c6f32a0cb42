#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "method.h"

namespace spherule::bench {

// The kernels of tests/bench/kernels/, and the program's shaders that they include.
const compute::SourceSet& benchSources();

// A method as a list of launches over its own arrays. The first failure of array(), stage() or response() is kept, and
// later calls have no effect. ready() returns that failure.
class Baseline final : public Method {
  public:
    // PingPong: a substep writes to the other half of the state. InPlace: back to the half that it reads.
    enum class State { PingPong, InPlace };

    Baseline(const Setting& setting, State state);

    compute::Buffer* array(std::string_view label, std::size_t bytes);
    void stage(std::string_view kernel, std::vector<compute::Buffer*> buffers, std::uint32_t count,
               std::uint32_t phase = 0);
    // Adds a response kernel. It binds the state, the tally, then `buffers`: the arrays of the broad phase.
    void response(std::string_view kernel, const std::vector<compute::Buffer*>& buffers);
    void define(std::string name, std::string value) { defines_.push_back({std::move(name), std::move(value)}); }

    // The halves of the state: 0 is the half that the first substep reads. With PingPong, stage() swaps them for odd
    // substeps.
    [[nodiscard]] compute::Buffer* position(unsigned half) const { return position_[half]; }
    [[nodiscard]] compute::Buffer* velocity(unsigned half) const { return velocity_[half]; }
    [[nodiscard]] compute::Buffer* tallyArray() const { return tally_; }

    [[nodiscard]] Result<void> ready() const;

    void upload(const sim::State& state) override;
    void substep() override;
    std::string note() override;

    std::vector<glm::vec4> positions();  // w = radius, in any order
    std::uint64_t contacts();            // since the upload; each pair counts once a substep
    std::uint32_t overflowed();          // spheres whose cell was full, summed over the substeps

  private:
    struct Stage {
        compute::Kernel* kernel = nullptr;
        std::vector<compute::Buffer*> buffers[2];  // for even and odd substeps
        std::uint32_t count = 0;
        std::uint32_t phase = 0;
    };
    std::vector<compute::Buffer*> swapped(std::vector<compute::Buffer*> buffers) const;
    std::vector<std::uint32_t> tally();

    Setting setting_;
    State state_;
    std::vector<compute::Define> defines_;
    std::vector<std::unique_ptr<compute::Buffer>> arrays_;
    std::vector<std::unique_ptr<compute::Kernel>> kernels_;
    compute::Buffer* position_[2] = {};
    compute::Buffer* velocity_[2] = {};
    compute::Buffer* tally_ = nullptr;
    compute::Buffer* parameters_ = nullptr;
    std::vector<Stage> stages_;
    unsigned substeps_ = 0;
    Error error_;
    bool failed_ = false;
};

}  // namespace spherule::bench
