// The kernels with perturbed arithmetic. SPHERULE_PERTURBED_SEED: the seed; 1 without it. SPHERULE_PERTURBED_DIVISIONS
// and SPHERULE_PERTURBED_PRODUCTS: the largest errors (ulp). SPHERULE_PERTURBED_KERNEL: only kernels whose C++ name has
// this text are perturbed, to find the one that breaks a law.
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
                                   .divisions = fromEnvironment("SPHERULE_PERTURBED_DIVISIONS", 2),
                                   .products = fromEnvironment("SPHERULE_PERTURBED_PRODUCTS", 1)};
    return only;
}

bool isAsked(std::string_view kernel) {
    static const char* const text = std::getenv("SPHERULE_PERTURBED_KERNEL");
    return text == nullptr || kernel.find(text) != std::string_view::npos;
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
    if (!instruments::isAsked(__PRETTY_FUNCTION__)) instruments::perturbation.seed = 0;
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
