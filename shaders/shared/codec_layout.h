// The layout on which the host and the kernels of the codec agree. docs/codec.md describes the words of a frame.

#define CODEC_BLOCK 64u         // spheres
#define CODEC_VALUES 192u       // of a block: 64 x, 64 y, 64 z; on each axis, sphere k is at laneOf(k)
#define CODEC_RUN 8u            // spheres that share their widths
#define CODEC_RUNS 24u          // of a block
#define CODEC_GROUP 32u         // blocks
#define CODEC_CHUNK 8u          // groups
#define CODEC_FRAME_HEAD 4u     // words
#define CODEC_TURNS_HEAD 7u     // the same with turns
#define CODEC_MOST_WORDS 197u   // of a block
#define CODEC_PACKED 208u       // words from one packed block to the next before they are placed: whole cache lines
#define CODEC_VALUE_SHIFT 17u   // bits of a float that the code of a value leaves out: 64 codes per power of two
#define CODEC_SPIN_SHIFT 19u    // the same for a component of an angular velocity: 16 codes per power of two
#define CODEC_MASK_WIDTHS 12u   // no mask is tried if x, y and z together have more bits

#define CODEC_MAGIC 0x00015053u
#define CODEC_KEYFRAME 0x01000000u  // flags of a frame
#define CODEC_HASHED 0x02000000u
#define CODEC_TURNS 0x04000000u

#define CODEC_PLAIN 0u          // modes
#define CODEC_MASK 1u
#define CODEC_SELECT 2u
#define CODEC_BASE 3u

#define CODEC_PREVIOUS 0u       // predictors
#define CODEC_LINEAR 1u
#define CODEC_HALF 2u
#define CODEC_NONE 3u

// Scratch of a block:
// - HEADER: the block's header in the lower half; in the upper half, the header of the group's next present block
// - SIZE: in units; 0: the block is absent
// - OFFSET: in units, within the chunks
#define CODEC_SCRATCH 4u        // words
#define CODEC_HEADER 0u
#define CODEC_SIZE 1u
#define CODEC_OFFSET 2u

// Values of `quantity`. From CODEC_FIGURES on a component of the row is coded: CODEC_FIGURES is x.
#define CODEC_POSITIONS 0u
#define CODEC_LENGTHS 1u        // of x, y, z
#define CODEC_FIGURES 2u
#define CODEC_SPINS 255u        // x, y, z with their signs

// The uniform block, std140.
struct Parameters {
    vec4 origin;         // m
    vec4 perQuantum;     // 1/m: 1 / quantum of each axis; for quantities x: 1 / unit
    vec4 period;         // m: length of each periodic axis; 0: not periodic
    uvec4 turns;         // quanta in these lengths, modulo which positions are counted; 0: they are not
    uint head;           // words of the frame before the table of chunks
    uint quantity;       // the coded part of each row, such as CODEC_POSITIONS
    uint unusedUint1;
    uint unusedUint2;
    uint spheres;
    uint blocks;
    uint groups;
    uint chunks;
    uint number;         // of the frame
    uint flags;
    uint predictors;     // one bit for each predictor that blocks may have
    uint fromState;      // not 0: the frame is made from `newest`, which stays unchanged, instead of positions
};
