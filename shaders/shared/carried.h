// The contacts that a sphere owns while the lists are rebuilt. The includer binds `carriedCount` and `counters`.
//
// A word of `carriedCount` has two counts of 16 bits, which the lists of all spheres use in turn. list_reference.comp
// clears the count of the next ones. Lists of movers alone use the same count as the lists of all spheres before them,
// and clear it where they need it (contacts_carry.comp). Each of their rows has COUNTER_MOVER_LISTS, so that older rows
// are no contacts.

#define FIRST_OWNS 0x80000000u  // in the id of the partner: the owner was the first sphere of the pair
#define LISTS_SHIFT 24u         // in the id of the partner: the place of COUNTER_MOVER_LISTS, 7 bits

// The partner in a row, with the lists that are built.
uint partnerWord(uint id) {
    return id | (counters[COUNTER_MOVER_LISTS] << LISTS_SHIFT);
}

uint shiftOfCount() {
    return 16u * (counters[COUNTER_LISTS] & 1u);
}

uint oneMoreCarried() {
    return 1u << shiftOfCount();
}

// The count in a word.
uint countIn(uint word) {
    return (word >> shiftOfCount()) & 0xffffu;
}

// None are carried if there are too many: which of them have a row depends on the order of the threads.
uint carriedBy(uint owner) {
    uint count = countIn(carriedCount[owner]);
    return count <= CARRIED_MOST ? count : 0u;
}

uint withoutNextCount(uint word) {
    return word & (0xffffu << shiftOfCount());
}
