// Words of the `tally` buffer.
#define TALLY_CONTACTS 0u    // counted from both sides
#define TALLY_OVERFLOWED 1u  // spheres whose cell was full
#define TALLY_WORDS 2u
