// Tests every sphere against every other.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/contact.h"
#include "tally.h"
#include "response.h"

KERNEL(params.spheres) {
    begin(invocation);
    for (uint other = 0u; other < params.spheres; ++other) meet(other);
    finish();
}
