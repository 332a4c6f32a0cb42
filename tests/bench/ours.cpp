#include <spdlog/fmt/fmt.h>

#include "methods.h"
#include "stopwatch.h"

namespace spherule::bench {

namespace {

class Ours final : public Method {
  public:
    explicit Ours(sim::Simulation& simulation) : simulation_(simulation) {}

    void upload(const sim::State& state) override {
        simulation_.upload(state);
        substeps_ = 0;
    }

    void substep() override {
        simulation_.pipeline().substep();
        ++substeps_;
    }

    // Long enough for several rebuilds of the lists. The upload requests one, which the first substep does.
    [[nodiscard]] unsigned period() const override { return mostSubsteps; }

    std::string note() override {
        const auto words = simulation_.pipeline().read<std::uint32_t>(sim::Array::Counters);
        std::string text =
            fmt::format("{:.2f} rebuilds per substep", words[COUNTER_REBUILDS] / std::max(substeps_, 1.0));
        if (words[COUNTER_UNLISTED] > 0) text += fmt::format("; {} groups without lists", words[COUNTER_UNLISTED]);
        return text;
    }

  private:
    sim::Simulation& simulation_;
    double substeps_ = 0;
};

}  // namespace

std::unique_ptr<Method> ours(sim::Simulation& simulation) {
    return std::make_unique<Ours>(simulation);
}

}  // namespace spherule::bench
