// Packs a block into the units that it has in the frame. The includer has the buffer `blockWords`, and as PRIVATE
// variables values[], spread[], most[] and the best choice (bestMode and the others).

PRIVATE(uint, word)  // the word that is being filled
PRIVATE(uint, fill)  // bits in it, below 32
PRIVATE(uint, at)    // index of the word in blockWords
PRIVATE(uint, runWidth[CODEC_RUNS])    // bits of a run's values
PRIVATE(uint, runChanged[CODEC_RUNS])  // one bit for each value of a run
PRIVATE(uint, selectors[CODEC_RUNS])
PRIVATE(uint, runLow[CODEC_RUNS])      // the values of a run, if two words can hold them
PRIVATE(uint, runHigh[CODEC_RUNS])

// Appends a value of `bits` bits, at most 32. Always writes the word, even before it is full: a mispredicted branch
// costs more than a write.
void put(uint value, uint bits) {
    word = word | (value << fill);
    blockWords[at] = word;
    uint next = fill + bits;
    uint full = next >> 5u;
    uint rest = (value >> 1u) >> (31u - fill);
    word = (word & (full - 1u)) | (rest & (0u - full));
    at = at + full;
    fill = next & 31u;
}

// Appends up to 64 bits, the first 32 in `first`. `bits` is a multiple of 8.
void putLong(uint first, uint second, uint bits) {
    uint a = word | (first << fill);
    uint b = ((first >> 1u) >> (31u - fill)) | (second << fill);
    uint c = (second >> 1u) >> (31u - fill);
    blockWords[at] = a;
    blockWords[at + 1u] = b;
    uint next = fill + bits;
    uint full = next >> 5u;
    word = full == 0u ? a : (full == 1u ? b : c);
    at = at + full;
    fill = next & 31u;
}

uint joinFour(int k, uint bits) {
    return values[k] | (values[k + 8] << bits) | (values[k + 16] << (2u * bits)) | (values[k + 24] << (3u * bits));
}

// Joins the values of each run. Runs of widths up to 8 take at most two words; the words joined for wider runs are not
// used.
void joinRuns() {
    for (int axis = 0; axis < 3; ++axis)
        for (int run = 8 * axis; run < 8 * axis + 8; ++run) {
            int k = 56 * axis + run;
            uint bits = min(runWidth[run], 8u);
            uint four = joinFour(k, bits);
            uint more = joinFour(k + 32, bits);
            runLow[run] = four | ((more << (2u * bits)) << (2u * bits));
            runHigh[run] = (more >> (16u - bits * 2u)) >> (16u - 2u * bits);
        }
}

// Appends the values of all runs. The values of a run are eight places apart.
void putRuns() {
    joinRuns();
    for (int run = 0; run < 24; ++run) {
        uint bits = runWidth[run];
        int first = run + run / 8 * 56;
        if (bits <= 8u)
            putLong(runLow[run], runHigh[run], 8u * bits);
        else if (bits <= 16u)
            for (int k = first; k < first + 64; k += 16) put(values[k] | (values[k + 8] << bits), 2u * bits);
        else
            for (int k = first; k < first + 64; k += 8) put(values[k], bits);
    }
}

// Appends bitmaps that mark the values other than 0, then these values.
void putChanged() {
    for (int axis = 0; axis < 3; ++axis) {
        uint there = 0u;
        for (int run = 0; run < 8; ++run) {
            uint bits = 0u;
            for (int k = 0; k < 8; ++k) bits = bits | (uint(values[64 * axis + 8 * k + run] != 0u) << k);
            runChanged[8 * axis + run] = bits;
            there = there | (uint(bits != 0u) << run);
        }
        put(there, 8u);
    }
    for (int run = 0; run < 24; ++run)
        if (runChanged[run] != 0u) put(runChanged[run], 8u);
    for (int run = 0; run < 24; ++run)
        for (uint rest = runChanged[run]; rest != 0u; rest = rest & (rest - 1u))
            put(values[run + run / 8 * 56 + 8 * findLSB(rest)] - 1u, runWidth[run]);
}

// The bits of all values of an axis that are not 0, each less 1, joined by OR.
uint spreadOfChanged(int axis) {
    uint all = 0u;
    for (int k = 64 * axis; k < 64 * axis + 64; ++k) all = all | (values[k] - uint(values[k] != 0u));
    return all;
}

void takeSpreadOfValues() {
    for (int axis = 0; axis < 3; ++axis) {
        uint all = 0u;
        for (int run = 8 * axis; run < 8 * axis + 8; ++run) {
            int k = run + 56 * axis;
            uint bits = values[k] | values[k + 8] | values[k + 16] | values[k + 24] | values[k + 32] | values[k + 40] |
                        values[k + 48] | values[k + 56];
            spread[run] = bits;
            all = all | bits;
        }
        most[axis] = all;
    }
}

// Sets the widths and selectors of the runs. Returns the header with the codes of the axes.
uint takeWidths() {
    uint header = bestMode | (bestPredictor << 2u);
    uint widest[CODEC_RUNS];
    for (int axis = 0; axis < 3; ++axis) {
        uint code = codeFor(bestMode == CODEC_MASK ? spreadOfChanged(axis) : most[axis]);
        for (int run = 8 * axis; run < 8 * axis + 8; ++run) widest[run] = code;
        header = header | (code << (4 + 4 * axis));
    }
    uint narrower = bestMode < CODEC_SELECT ? 0u : 3u;  // codes by which a run may be narrower than its axis, at most
    for (int run = 0; run < 24; ++run) {
        uint least = max(widest[run], narrower) - narrower;
        uint code = min(max(codeFor(spread[run]), least), widest[run]);
        runWidth[run] = widthOf(code);
        selectors[run] = widest[run] - code;
    }
    return header;
}

// Joins the selectors of an axis: two bits for each run.
uint joinSelectors(int axis) {
    uint all = 0u;
    for (int run = 0; run < 8; ++run) all = all | (selectors[8 * axis + run] << (2 * run));
    return all;
}

// Packs the block into blockWords, from index `place` on. Returns the header.
uint packBlock(uint place) {
    word = 0u;
    fill = 0u;
    at = place;
    takeSpreadOfValues();
    uint header = takeWidths();
    put(header, 16u);
    if (bestMode >= CODEC_SELECT)
        for (int axis = 0; axis < 3; ++axis) put(joinSelectors(axis), 16u);
    if (bestMode == CODEC_BASE && bestPredictor == CODEC_NONE)
        for (int axis = 0; axis < 3; ++axis) put(bestBase[axis], 32u);
    if (bestMode == CODEC_BASE && bestPredictor != CODEC_NONE) put(bestField, 32u);
    if (bestMode == CODEC_MASK)
        putChanged();
    else
        putRuns();
    blockWords[at] = word;
    return header;
}
