// Sums over the contacts of the pairs that an invocation visits, in scenes with contact sums: the virial, and the number
// of collisions. The rows are behind the words of the bundles, one for each bundle and thread. The host adds them up and
// clears them. The includer binds `bundles`.
//
// The virial of a pair in a substep is the product of branch (m) and impulse on the first sphere (N s), symmetrized. The
// branch is the vector from the second centre to the first. At an impact, it is the vector at that moment.

PRIVATE(real3, virialDiagonal)  // xx, yy, zz
PRIVATE(real3, virialOther)     // xy, xz, yz
PRIVATE(real, collisions)

void beginContactSums() {
    virialDiagonal = real3(0.0f, 0.0f, 0.0f);
    virialOther = virialDiagonal;
    collisions = real(0.0f);
}

RARE void addToContactSums(mask where, real3 branch, real3 impulse, mask collides) {
    real3 none = real3(0.0f, 0.0f, 0.0f);
    real3 along = real3(branch.x * impulse.x, branch.y * impulse.y, branch.z * impulse.z);
    real3 across = real3(branch.x * impulse.y + branch.y * impulse.x, branch.x * impulse.z + branch.z * impulse.x,
                         branch.y * impulse.z + branch.z * impulse.y);
    virialDiagonal = virialDiagonal + select(where, along, none);
    virialOther = virialOther + select(where, across * 0.5f, none);
    collisions = collisions + select(where && collides, real(1.0f), real(0.0f));
}

// A macro: with a function, glslang needs minutes, because `precise` spreads through its parameter.
#define ADD_TO_SUM(word, value) bundles[word] = floatBitsToUint(uintBitsToFloat(bundles[word]) + SUM_OF_LANES(value));

void endContactSums(uint bundle) {
    uint row = (params.bundles + 1u) * BUNDLE_WORDS + (bundle * MOST_PAIR_THREADS + THREAD) * SUM_WORDS;
    ADD_TO_SUM(row, virialDiagonal.x)
    ADD_TO_SUM(row + 1u, virialDiagonal.y)
    ADD_TO_SUM(row + 2u, virialDiagonal.z)
    ADD_TO_SUM(row + 3u, virialOther.x)
    ADD_TO_SUM(row + 4u, virialOther.y)
    ADD_TO_SUM(row + 5u, virialOther.z)
    ADD_TO_SUM(row + 6u, collisions)
}
