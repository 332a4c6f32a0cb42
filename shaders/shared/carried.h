// The contacts that a sphere owns while the lists are rebuilt. The includer binds `carriedCount` and `counters`.

#define FIRST_OWNS 0x80000000u  // in the id of the partner: the owner was the first sphere of the pair

uint carriedBy(uint owner) {
    uint word = carriedCount[owner];
    return word >> 8u == (counters[COUNTER_LISTS] & 0xffffffu) ? word & 0xffu : 0u;
}
