// The pairs of a group of 2 x 2 x 2 cells. Its cells are paired with themselves and with their 13 forward neighbours,
// and its spheres with the spheres of finer levels. The includer defines before
// `void visitRange(uint a, uint b, uint end)`, which visits the pairs of a with the spheres b .. end - 1, and binds
// `cellStart` and `position`.
//
// A smaller sphere within reach of a larger one lies at most one cell from the larger one's cell, on the larger one's
// level. Two blocks of one colour and level, whose cells are more than two apart, therefore never touch the same
// sphere. (Without lists, both may visit the same sphere; it is far away from one of them.)

#include "shared/cell_runs.h"

// A cell with more spheres than sampleThreshold() is overfull: in each round, each of its spheres is paired only with a
// sample of the others. The sample has at most SAMPLE_MOST spheres. It has fewer, but at least SAMPLE_LEAST, if the
// cell holds very many, so that the work of a cell is bounded.
#define SAMPLE_MOST 32u
#define SAMPLE_LEAST 4u
#define SAMPLE_VISITS 32768u

PRIVATE(bool, sampled)  // some cells held so many spheres that not all of their pairs were visited
PRIVATE(Reach, reached)
PRIVATE(CellRun, chord)

// Has only one call of visitRange: GLSL compilers copy the function to each call, which takes seconds.
void visitCell(uint level, uint x, uint y, uint z, uint sampleRound) {
    uvec4 cells = cellsOf(level);
    uint cell = cellIndex(cells, x, y, z);
    uint first = cellStart[cell];
    uint last = cellStart[cell + 1u];
    if (first == last) return;
    uint nx = cells.x;
    uint west = x == 0u ? nx - 1u : x - 1u;
    uint east = x + 1u == nx ? 0u : x + 1u;
    uint north = y + 1u == cells.y ? 0u : y + 1u;
    uint south = y == 0u ? cells.y - 1u : y - 1u;
    uint above = z + 1u == cells.z ? 0u : z + 1u;
    bool whole = x > 0u && x + 1u < nx;
    uint sampleSize = max(SAMPLE_LEAST, min(SAMPLE_VISITS / (last - first), SAMPLE_MOST));
    // One pass for the level itself, then one for each sphere and each finer level.
    uint passes = HAS(LEVELS) ? 1u + (last - first) * level : 1u;
    for (uint pass = 0u; pass < passes; ++pass) {
        bool finer = HAS(LEVELS) && pass > 0u;
        uint one = first;
        if (finer) {
            one = first + (pass - 1u) / level;
            reached = reachOf(position[one], (pass - 1u) % level);
        }
        // On the level itself, row 0 is the cell itself and the cell to the east. The other rows are cells x - 1 .. x +
        // 1 to the north, above the south, above, and above the north. Each row is one range of the sorted spheres
        // unless the torus cuts it.
        uint rows = finer ? reached.rows : 5u;
        for (uint row = 0u; row < rows; ++row) {
            uint ry = row == 0u || row == 3u ? y : (row == 2u ? south : north);
            uint reachedY = finer ? row / reached.z.count : 0u;
            uint reachedZ = row - reachedY * (finer ? reached.z.count : 0u);
            uint start = finer ? rowStart(reached, reachedY, reachedZ) : cellIndex(cells, 0u, ry, row < 2u ? z : above);
            uint parts = row == 0u ? 2u : (whole ? 1u : 3u);
            if (finer) {
                chord = rowRun(reached, reachedY, reachedZ);
                uint ends = chord.start + chord.count;
                parts = chord.count == 0u ? 0u : (ends > reached.cells.x ? 2u : 1u);
            }
            for (uint part = 0u; part < parts; ++part) {
                uint from = row == 0u ? (part == 0u ? x : east) : (part == 0u ? west : (part == 1u ? x : east));
                uint to = row > 0u && whole ? east : from;
                if (finer) {
                    uint ends = chord.start + chord.count - 1u;
                    from = part == 0u ? chord.start : 0u;
                    to = part == 0u ? min(ends, reached.cells.x - 1u) : ends - reached.cells.x;
                }
                uint begin = cellStart[start + from];
                uint end = cellStart[start + to + 1u];
                if (begin == end) continue;
                uint threshold = (to - from + 1u) * sampleThreshold(finer ? (pass - 1u) % level : level);
                uint until = finer ? one + 1u : last;
                for (uint a = one; a < until; ++a) {
                    uint b = row + part == 0u && !finer ? a + 1u : begin;
                    uint stop = end;
                    if (stop - b > threshold) {
                        // Visits a share of the others now and another share in the next round.
                        uint shares = (stop - b + sampleSize - 1u) / sampleSize;
                        b = b + sampleRound % shares * sampleSize;
                        stop = min(b + sampleSize, stop);
                        sampled = true;
                    }
                    visitRange(a, b, stop);
                }
            }
        }
    }
}

// `sampleRound` selects the share of the pairs of an overfull cell that is visited. Successive rounds visit all shares
// in turn.
void visitGroupNumber(uint group, uint sampleRound) {
    uint level = levelOfGroup(group);
    uvec4 cells = cellsOf(level);
    uint gx = cells.x / 2u;
    uint gz = cells.z / 2u;
    uint at = group - firstCell(cells) / 8u;
    uint x = at % gx;
    uint y = at / (gx * gz);
    uint z = (at / gx) % gz;
    sampled = false;
    for (uint k = 0u; k < 8u; ++k)
        visitCell(level, 2u * x + (k & 1u), 2u * y + ((k >> 1u) & 1u), 2u * z + (k >> 2u), sampleRound);
}

// Visits all pairs of a bundle. The includer includes shared/bundles.h before.
void visitBundle(uint bundle, uint sampleRound) {
    uint level = levelOfBundle(bundle);
    for (uint part = 0u; part < BLOCKS_PER_BUNDLE; ++part) {
        BlockPlace block = blockOfBundle(bundle, level, part);
        for (uint k = 0u; k < 8u && block.exists; ++k)
            visitGroupNumber(groupOfBlock(cellsOf(level), block, k), sampleRound);
    }
}
