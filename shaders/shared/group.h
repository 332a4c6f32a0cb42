// The pairs of a group of 2 x 2 x 2 cells. Its cells are paired with themselves and with their 13 forward neighbours,
// and its spheres with the spheres of finer levels. The includer defines before
// `void visitRange(uint a, uint b, uint end)`, which visits the pairs of entry a with the entries b .. end - 1
// (shared/movers.h), and binds `cellStart` and `position`.
//
// A smaller sphere within reach of a larger one lies at most one cell from the larger one's cell, on the larger one's
// level. Two blocks of one colour and level, whose cells are more than two apart, therefore never touch the same
// sphere. (Without lists, both may visit the same sphere; it is far away from one of them.)

#include "shared/cell_runs.h"

// By how much (m) the gaps of a sphere's pairs may exceed the margin. An includer that makes lists defines FOR_LISTS and
// this function.
#ifndef FOR_LISTS
float moreReach(uint slot) {
    return 0.0f;
}
#endif

// A cell with more spheres than sampleThreshold() is overfull: in each round, each of its spheres is paired only with a
// sample of the others. The sample has at most SAMPLE_MOST spheres. It has fewer, but at least SAMPLE_LEAST, if the
// cell holds very many, so that the work of a cell is bounded.
#define SAMPLE_MOST 32u
#define SAMPLE_LEAST 4u
#define SAMPLE_VISITS 32768u

PRIVATE(uint, sampled)  // spheres in or beside so many others that not all of their pairs were visited
PRIVATE(Reach, reached)
PRIVATE(CellRun, chord)
PRIVATE(uvec4, cellPlace)  // x, y, z of the cell whose spheres are visited

// The first cell of a row of cells of the own level. Row 0 has the cell itself and the cell to the east. The other rows
// are to the north, above the south, above, and above the north.
uint firstOfRow(uvec4 cells, uint row) {
    uint y = cellPlace.y;
    uint z = cellPlace.z;
    uint north = y + 1u == cells.y ? 0u : y + 1u;
    uint south = y == 0u ? cells.y - 1u : y - 1u;
    uint above = z + 1u == cells.z ? 0u : z + 1u;
    return cellIndex(cells, 0u, row == 0u || row == 3u ? y : (row == 2u ? south : north), row < 2u ? z : above);
}

// The first and the last cell of part `part` of such a row. Without the torus, it is one range of the sorted spheres.
uvec2 partOfRow(uvec4 cells, uint row, uint part) {
    uint x = cellPlace.x;
    uint west = x == 0u ? cells.x - 1u : x - 1u;
    uint east = x + 1u == cells.x ? 0u : x + 1u;
    if (row == 0u) return part == 0u ? uvec2(x, x) : uvec2(east, east);
    if (west < east) return uvec2(west, east);
    return part == 0u ? uvec2(west, west) : (part == 1u ? uvec2(x, x) : uvec2(east, east));
}

uint partsOfRow(uvec4 cells, uint row) {
    if (row == 0u) return 2u;
    return cellPlace.x > 0u && cellPlace.x + 1u < cells.x ? 1u : 3u;
}

// The same for the chord of a finer level.
uvec2 partOfChord(uvec4 cells, uint part) {
    uint end = chord.start + chord.count - 1u;
    return part == 0u ? uvec2(chord.start, min(end, cells.x - 1u)) : uvec2(0u, end - cells.x);
}

uint partsOfChord(uvec4 cells) {
    if (chord.count == 0u) return 0u;
    return chord.start + chord.count > cells.x ? 2u : 1u;
}

// The entries from `b` on that the sphere meets in this round: all of `count`, or a sample.
uvec2 sampleOf(uint b, uint count, uint size, uint sampleRound) {
    // Visits a share of the others now and another share in the next round.
    uint shares = (count + size - 1u) / size;
    uint skipped = sampleRound % shares * size;
    return uvec2(b + skipped, b + min(skipped + size, count));
}

// Finds the chord of row `row` of the finer level that a sphere reaches. Returns the row's first cell.
uint firstOfChord(uint row) {
    uint y = row / reached.z.count;
    uint z = row - y * reached.z.count;
    chord = rowRun(reached, y, z);
    return rowStart(reached, y, z);
}

// Visits the pairs of an entry of the cell. Has only one call of visitRange: GLSL compilers copy the function to each
// call, which takes seconds.
void visitSphere(uint a, uint level, uint sampleSize, uint sampleRound) {
    bool sampledHere = false;
    // One pass for the level itself, then one for each finer level.
    uint passes = HAS(LEVELS) ? 1u + level : 1u;
    for (uint pass = 0u; pass < passes; ++pass) {
        bool finer = HAS(LEVELS) && pass > 0u;
        uint other = finer ? pass - 1u : level;
        uvec4 cells = cellsOf(other);
        if (finer) reached = reachOf(position[slotOfEntry(a)], other, moreReach(slotOfEntry(a)));
        uint rows = finer ? reached.rows : 5u;
        for (uint row = 0u; row < rows; ++row) {
            uint first = finer ? firstOfChord(row) : firstOfRow(cells, row);
            uint parts = finer ? partsOfChord(cells) : partsOfRow(cells, row);
            for (uint part = 0u; part < parts; ++part) {
                uvec2 span = finer ? partOfChord(cells, part) : partOfRow(cells, row, part);
                uint begin = !finer && row + part == 0u ? a + 1u : cellStart[first + span.x];
                uvec2 range = uvec2(begin, cellStart[first + span.y + 1u]);
                if (range.x == range.y) continue;
                if (range.y - range.x > (span.y - span.x + 1u) * sampleThreshold(other)) {
                    range = sampleOf(range.x, range.y - range.x, sampleSize, sampleRound);
                    sampledHere = true;
                }
                visitRange(a, range.x, range.y);
            }
        }
    }
    if (sampledHere) sampled = sampled + 1u;
}

// The place of a group's first cell among the cells of its level: x, y, z.
uvec4 placeOfGroup(uvec4 cells, uint group) {
    uint gx = cells.x / 2u;
    uint gz = cells.z / 2u;
    uint at = group - firstCell(cells) / 8u;
    return uvec4(2u * (at % gx), 2u * (at / (gx * gz)), 2u * ((at / gx) % gz), 0u);
}

// The place of cell `k` (0 .. 7) of a group. `group`: the place of its first cell.
uvec4 placeInGroup(uvec4 group, uint k) {
    return uvec4(group.x + (k & 1u), group.y + ((k >> 1u) & 1u), group.z + (k >> 2u), 0u);
}

uint cellAt(uvec4 cells, uvec4 place) {
    return cellIndex(cells, place.x, place.y, place.z);
}

uint spheresOfGroup(uvec4 cells, uvec4 group) {
    uint spheres = 0u;
    for (uint k = 0u; k < 8u; ++k) {
        uint cell = cellAt(cells, placeInGroup(group, k));
        spheres = spheres + cellStart[cell + 1u] - cellStart[cell];
    }
    return spheres;
}

// Visits the pairs of one of `shares` equal shares of the spheres of a group. `sampleRound` selects the share of the
// pairs of an overfull cell that is visited. Successive rounds visit all of them in turn. The outer loop is over
// spheres, not over cells, so that threads whose spheres are in different cells visit them at the same time.
void visitShareOfGroup(uint group, uint share, uint shares, uint sampleRound) {
    uint level = levelOfGroup(group);
    uvec4 cells = cellsOf(level);
    uvec4 groupPlace = placeOfGroup(cells, group);
    uint spheres = spheresOfGroup(cells, groupPlace);
    uint size = (spheres + shares - 1u) / shares;
    uint to = min((share + 1u) * size, spheres);
    uint cell = 0u;       // the next cell of the group (0 .. 8)
    uint endOfCell = 0u;  // spheres in the cells before it
    uint first = 0u;      // sphere `k` of the group has the place first + k; may wrap
    uint sampleSize = 0u;
    for (uint k = share * size; k < to; ++k) {
        while (k >= endOfCell) {
            cellPlace = placeInGroup(groupPlace, cell);
            uint at = cellAt(cells, cellPlace);
            first = cellStart[at] - endOfCell;
            uint count = cellStart[at + 1u] - cellStart[at];
            sampleSize = max(SAMPLE_LEAST, min(SAMPLE_VISITS / max(count, 1u), SAMPLE_MOST));
            endOfCell = endOfCell + count;
            cell = cell + 1u;
        }
        visitSphere(first + k, level, sampleSize, sampleRound);
    }
}

// Visits all pairs of a bundle. The includer includes shared/bundles.h before.
void visitBundle(uint bundle, uint sampleRound) {
    uint level = levelOfBundle(bundle);
    for (uint part = 0u; part < BLOCKS_PER_BUNDLE; ++part) {
        BlockPlace block = blockOfBundle(bundle, level, part);
        for (uint k = 0u; k < 8u && block.exists; ++k)
            visitShareOfGroup(groupOfBlock(cellsOf(level), block, k), 0u, 1u, sampleRound);
    }
}
