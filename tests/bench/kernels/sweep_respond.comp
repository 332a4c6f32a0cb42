// Tests every sphere against its neighbours in the order along x, in both directions, up to one diameter away. Spheres
// with the same key are not sorted, so the search goes one strip farther.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/contact.h"
#include "tally.h"
#include "response.h"
#include "sweep.h"

KERNEL(params.spheres) {
    begin(invocation);
    float reach = 2.0f * params.radius + 1.01f * stripWidth();
    for (uint k = invocation + 1u; k < params.spheres && position[k].x - here.x < reach; ++k) meet(k);
    for (uint k = invocation; k > 0u && here.x - position[k - 1u].x < reach; --k) meet(k - 1u);
    finish();
}
