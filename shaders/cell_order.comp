// Sorts the spheres of each cell by id, because the scatter leaves them in the device's order of execution. A work group
// has ORDERED_CELLS cells. Each of its threads sorts some of them; all threads together sort the crowded ones, one after
// the other. A radix sort reads each sphere of a crowd a fixed number of times.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"

BUFFER(readonly, uint, cellStart)
BUFFER(coherent, uint, cellOrder)
BUFFER(coherent, uint, otherOrder)  // every second turn of the sort of a crowd writes here
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uint, counters)

#include "shared/movers.h"

#define MOST_BY_THREAD 32u  // spheres that a single thread sorts
#define DIGITS 16u
#define DIGIT_BITS 4u
#define DIGITS_OF_ID 6u     // even, so that the last turn writes to `cellOrder`
#define ITERATIONS_WITHOUT_CROWDS 4096u  // an upper limit

SHARED(uint, crowded)
SHARED(uint, places[DIGITS * THREADS])  // by digit and thread: the spheres with it, then the place of the next one
SHARED(uint, totals[DIGITS])

void sortFew(uint first, uint count) {
    for (uint k = 1u; k < count; ++k) {
        uint moving = cellOrder[first + k];
        uint id = idOf(idAndMaterial[moving]);
        uint hole = k;
        for (; hole > 0u; --hole) {
            uint before = cellOrder[first + hole - 1u];
            if (idOf(idAndMaterial[before]) <= id) break;
            cellOrder[first + hole] = before;
        }
        cellOrder[first + hole] = moving;
    }
}

uint shareOf(uint count) {
    return (count + THREADS - 1u) / THREADS;
}

void sortCrowd(uint first, uint count) {
    uint begin = first + min(THREAD * shareOf(count), count);
    uint end = first + min((THREAD + 1u) * shareOf(count), count);
    for (uint turn = 0u; turn < DIGITS_OF_ID; ++turn) {
        bool there = turn % 2u == 0u;
        for (uint digit = 0u; digit < DIGITS; ++digit) places[digit * THREADS + THREAD] = 0u;
        for (uint k = begin; k < end; ++k) {
            uint id = idOf(idAndMaterial[there ? cellOrder[k] : otherOrder[k]]);
            uint place = (id >> (turn * DIGIT_BITS)) % DIGITS * THREADS + THREAD;
            places[place] = places[place] + 1u;
        }
        BARRIER
        for (uint digit = THREAD; digit < DIGITS; digit += THREADS) {
            uint sum = 0u;
            for (uint k = 0u; k < THREADS; ++k) {
                uint spheres = places[digit * THREADS + k];
                places[digit * THREADS + k] = sum;
                sum = sum + spheres;
            }
            totals[digit] = sum;
        }
        BARRIER
        uint start = first;
        for (uint digit = 0u; digit < DIGITS; ++digit) {
            places[digit * THREADS + THREAD] = places[digit * THREADS + THREAD] + start;
            start = start + totals[digit];
        }
        for (uint k = begin; k < end; ++k) {
            uint slot = there ? cellOrder[k] : otherOrder[k];
            uint place = (idOf(idAndMaterial[slot]) >> (turn * DIGIT_BITS)) % DIGITS * THREADS + THREAD;
            uint to = places[place];
            places[place] = to + 1u;
            if (there)
                otherOrder[to] = slot;
            else
                cellOrder[to] = slot;
        }
        BUFFER_BARRIER
    }
}

// Sorts the crowds among the cells. Mesa's software renderer ends the loops of an invocation after 65,535 iterations
// together. A crowd that needs more keeps the order of the scatter; list_build.comp then reports the same crowd.
void sortCrowds(uint firstCell, uint endCell) {
    uint iterations = ITERATIONS_WITHOUT_CROWDS;
    for (uint cell = firstCell; cell < endCell; ++cell) {
        uint count = cellStart[cell + 1u] - cellStart[cell];
        if (count <= MOST_BY_THREAD) continue;
        uint more = DIGITS_OF_ID * (2u * shareOf(count) + 2u * DIGITS + THREADS);
        if (LOOP_LIMIT != NO_LOOP_LIMIT && iterations + more > LOOP_LIMIT) continue;
        iterations = iterations + more;
        sortCrowd(cellStart[cell], count);
    }
}

BUNDLE_KERNEL((allCells() + ORDERED_CELLS - 1u) / ORDERED_CELLS) {
    uint firstCell = firstBuiltCell() + invocation * ORDERED_CELLS;
    uint endCell = min(firstCell + ORDERED_CELLS, allCells());
    if (FIRST_THREAD) crowded = 0u;
    BARRIER
    for (uint cell = firstCell + THREAD; cell < endCell; cell += THREADS) {
        uint first = cellStart[cell];
        uint count = cellStart[cell + 1u] - first;
        if (count <= MOST_BY_THREAD)
            sortFew(first, count);
        else
            atomicOr(crowded, 1u);
    }
    BARRIER
    if (crowded != 0u) sortCrowds(firstCell, endCell);
}
