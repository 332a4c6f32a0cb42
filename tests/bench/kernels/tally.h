// Words of the `tally` buffer.
#define TALLY_CONTACTS 0u   // counted from both sides
#define TALLY_OVERFLOWED 1u // spheres that found their cell full
#define TALLY_WORDS 2u
