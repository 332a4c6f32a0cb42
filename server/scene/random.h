#pragma once

#include <cstdint>
#include <random>

namespace spherule::scene {

// Random numbers that are the same with every compiler and standard library: only the engine's raw output and exactly
// rounded arithmetic are used, neither std::*_distribution nor the mathematical library.
class Random {
  public:
    // Streams of one seed are independent of each other.
    explicit Random(std::uint64_t seed, std::uint64_t stream = 0);

    // Returns a number in [0, 1), a multiple of 2^-53.
    double uniform();
    double uniform(double low, double high);

    // Returns a normal number with mean 0 and variance 1. Algorithm N of C. Karney, "Sampling exactly from the normal
    // distribution", ACM Trans. Math. Softw. 42 (2016): comparisons of uniform numbers alone.
    double normal();

  private:
    // Returns true with probability exp(-t), 0 <= t <= 1, by von Neumann's runs.
    bool withProbabilityOfExpMinus(double t);

    std::mt19937_64 engine_;
};

// Returns e^x for |x| <= 700, with the same bits with every compiler and mathematical library. It uses only the exactly
// rounded operations of double, and std::floor and std::ldexp, which are exact. The relative error is below 3e-16.
// Argument reduction and Pade form: exp.c of S. L. Moshier, Cephes Mathematical Library, release 2.2 (1992).
double portableExp(double x);

}  // namespace spherule::scene
