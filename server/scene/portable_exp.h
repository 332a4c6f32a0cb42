#pragma once

namespace spherule::scene {

// Returns e^x for |x| <= 700, with the same bits with every compiler and mathematical library. It uses only the exactly
// rounded operations of double, and std::floor and std::ldexp, which are exact. The relative error is below 3e-16.
// Argument reduction and Pade form: exp.c of S. L. Moshier, Cephes Mathematical Library, release 2.2 (1992).
double portableExp(double x);

}  // namespace spherule::scene
