#pragma once

#include <cstdint>

namespace spherule::sim {

// Counts spheres and their mass, and how many of them passed in the last full second (simulated).
class FlowMeter {
  public:
    void add(double time, std::uint64_t spheres, double mass);

    [[nodiscard]] std::uint64_t spheres() const { return total_.spheres; }
    [[nodiscard]] double mass() const { return total_.mass; }  // kg
    // Returns the flow in the last full second before `time`. No sphere was added after `time`.
    [[nodiscard]] double spheresPerSecond(double time) const;
    [[nodiscard]] double massPerSecond(double time) const;  // kg/s
    template <class Archive>
    void archive(Archive& a) {
        a(total_, present_, last_, second_);
    }

  private:
    struct Amount {
        std::uint64_t spheres = 0;
        double mass = 0;

        template <class Archive>
        void archive(Archive& a) {
            a(spheres, mass);
        }
    };
    // Returns the amount in the last full second before `time`.
    [[nodiscard]] Amount before(double time) const;

    Amount total_, present_, last_;  // in all, in the second `second_`, in the second before it
    double second_ = 0;              // whole seconds since the beginning
};

}  // namespace spherule::sim
