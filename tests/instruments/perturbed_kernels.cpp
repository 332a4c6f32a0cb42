// The kernels with perturbed arithmetic. SPHERULE_PERTURBED_SEED: the seed; 1 without it. SPHERULE_PERTURBED_ULP: the
// largest error of divisions, square roots and products (ulp), for a control.
#include <cstdlib>
#include <string>

#define SPHERULE_REAL Perturbed
#define SPHERULE_REAL_FUNCTIONS
#define SPHERULE_PRECISION perturbed
#include "perturbed_real.h"

#include "compute/cpu/glue.h"

namespace spherule::instruments {
namespace {

std::uint32_t fromEnvironment(const char* name, std::uint32_t otherwise) {
    const char* const text = std::getenv(name);
    return text == nullptr ? otherwise : static_cast<std::uint32_t>(std::stoul(text));
}

const Perturbation& asked() {
    static const Perturbation only{.seed = fromEnvironment("SPHERULE_PERTURBED_SEED", 1),
                                   .divisions = fromEnvironment("SPHERULE_PERTURBED_ULP", 2),
                                   .products = fromEnvironment("SPHERULE_PERTURBED_ULP", 1)};
    return only;
}

}  // namespace
}  // namespace spherule::instruments

namespace spherule::compute::cpu::perturbed::kernels {

using perturbed::countOf;

// The function of glue.h would inline all calls, which takes minutes with this class.
template <class Kernel>
void run(const Binding& binding, uint begin, uint end) {
    instruments::perturbation = instruments::asked();
    instruments::perturbation.salt = instruments::saltOf(__PRETTY_FUNCTION__, instruments::perturbation.seed);
    Kernel kernel(binding);
    for (uint invocation = begin; invocation < end; ++invocation) kernel.kernelBody(invocation);
}

}  // namespace spherule::compute::cpu::perturbed::kernels

#undef SPHERULE_PRECISION
#define SPHERULE_PRECISION perturbed::kernels
#define float Perturbed
#include "compute/cpu/all_kernels.h"
#undef float

// The linker finds this function before the one of the program.
namespace spherule::compute::cpu {

std::span<const Entry> floatKernels() {
    return perturbed::kernels::all;
}

}  // namespace spherule::compute::cpu
