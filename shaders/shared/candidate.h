// A row of `candidates`, a pair of near spheres before it has its place in the lists. The first word has the slot of the
// first sphere, the hash that chooses the batch, and a bit that is set if the pair is far. The second word has the slot
// of the other sphere and, once it is chosen, the pair's place among the places of its block (list_order.comp).

#define SLOT_BITS 0xffffffu
#define FAR_BIT 0x80000000u

// Returns the batch that the ids of a pair choose, below HASHED_BATCHES.
uint batchHash(uint ia, uint ib) {
    uint hash = min(ia, ib) * 0x9e3779b1u ^ (max(ia, ib) + 0x7f4a7c15u) * 0x85ebca6bu;
    hash ^= hash >> 15u;
    hash *= 0x2c1b3c6du;
    hash ^= hash >> 12u;
    return hash % HASHED_BATCHES;
}

uvec2 candidateOf(uint a, uint b, bool isFar, uint hash) {
    return uvec2(a | (hash << 24u) | (isFar ? FAR_BIT : 0u), b);
}

uint firstSphere(uvec2 candidate) {
    return candidate.x & SLOT_BITS;
}

uint secondSphere(uvec2 candidate) {
    return candidate.y & SLOT_BITS;
}

bool isFarPair(uvec2 candidate) {
    return candidate.x >= FAR_BIT;
}

uint hashOf(uvec2 candidate) {
    return (candidate.x >> 24u) & (HASHED_BATCHES - 1u);
}

uvec2 withPlace(uvec2 candidate, uint place) {
    return uvec2(candidate.x, candidate.y | (place << 24u));
}

uint placeOf(uvec2 candidate) {
    return candidate.y >> 24u;
}
