// The words of a mesh in the buffer `obstacleLists`, behind the list of all obstacles. All addresses are numbers of words
// in this buffer. Coordinates are in the frame of the obstacle (m).
//
// The row of the obstacle has the grid. a.xyz is its lowest corner, and a.w the reciprocal of the width of its cells
// (1/m). b.xyz is the number of its cells along each axis, and b.w its reach (m). A cell knows all nodes (MeshTree::tops)
// within the reach of its points.
// `cellsAt` is the address of its cells, along x first. A cell is the address of two lists, one behind the other. The
// first has the nodes within NEAR_SHARE of the reach, for spheres that move little, the second has the others. A list
// is numbers of nodes in ascending order, then END_OF_LIST. A cell without nodes has EMPTY_CELL, and bits of a
// distance (m): no point of the cell is nearer to the mesh.
#define EMPTY_CELL 0x80000000u
#define NEAR_SHARE 0.63f

// Nodes, triangles and edges fill whole lines of a cache.
#define LINE_WORDS 16u

// `nodesAt` is the address of the nodes (sim/mesh_tree.h). The word before it has the margin of the mesh (m): more than
// rounding errors of places, and more than corners of triangles lie beside the planes of their patches.
// A group has leaves as children, and a leaf has triangles. A node is between two planes. Across their normal, a box of its
// own is around each of its children. The boxes are on a grid of 127 by 127 steps around the centre. The boxes of four
// children are in four words, a byte for each child: lowest u, highest u, lowest v, highest v. The highest ones have
// TOP_BITS in addition.
#define NODE_WORDS (2u * LINE_WORDS)
#define NODE_NORMAL 0u    // of unit length
#define NODE_LOW 3u       // m: the two planes, from the centre along the normal
#define NODE_HIGH 4u
#define NODE_CENTRE 5u    // m
#define NODE_ACROSS 8u    // u, of unit length, across the normal; v is the cross product of the normal and u
#define NODE_STEPS 11u    // per metre
#define NODE_FIRST 12u    // address of the first child
#define NODE_COUNT 13u    // of children, at most CHILDREN_OF_NODE
#define NODE_IS_GROUP 14u // 1, else 0
#define NODE_BOXES LINE_WORDS
#define CHILDREN_OF_NODE 16u
#define STEPS_TO_CENTRE 63.5f
#define ALL_STEPS 127.0f
#define FOUR_BYTES 0x01010101u  // times a byte: the same in each byte
#define TOP_BITS 0x80808080u    // of each byte

#define TRIANGLE_WORDS (2u * LINE_WORDS)
#define TRIANGLE_NORMAL 0u    // of its patch, then the offset of the plane (m)
// Three planes across it, through its edges: the direction out of it, then the offset (m). All 0: the edge decides.
#define TRIANGLE_SIDES 4u
#define TRIANGLE_KEY 16u      // of a contact with the patch
#define TRIANGLE_FLAGS 17u
#define TRIANGLE_CLOSED 1u    // the triangle belongs to a solid
#define TRIANGLE_TURNED 2u    // this times 1 << k: its edge k is stored from its corner k + 1 to its corner k
#define TRIANGLE_EDGES 18u    // three: twice the address of an edge, plus 1 if the triangle is its second
#define TRIANGLE_VERTICES 21u // three: the address of a vertex that it owns and that spheres may touch, else 0
// A sphere beside the triangle may touch an edge or vertex of it only if it is beside it by at most this times its height
// above it. ANY_WEDGE: there is no such limit.
#define TRIANGLE_WEDGE 24u
#define ANY_WEDGE -1.0f

#define EDGE_WORDS LINE_WORDS
#define EDGE_FROM 0u    // m: its first end
#define EDGE_ALONG 3u   // its direction, of unit length
#define EDGE_LENGTH 6u  // m
#define EDGE_AWAY 7u    // two directions, of unit length: in the plane of each triangle, across the edge, out of it
#define EDGE_KEY 13u    // of a contact with the edge
#define EDGE_FLAGS 14u
#define EDGE_MEETS 1u   // spheres may touch it
#define EDGE_SHARED 2u  // two triangles have it
// In the model `accurate`: the triangles form a groove on their front or back, and have springs of their own.
#define EDGE_GROOVE 4u
#define EDGE_GROOVE_BEHIND 8u

#define VERTEX_PLACE 0u   // m
#define VERTEX_NORMAL 3u  // mean normal of its triangles, of any length; 0 without a solid
#define VERTEX_KEY 6u     // of a contact with the vertex
#define VERTEX_COUNT 7u   // of its edges; they follow: twice the address, plus 1 if the edge ends here
#define VERTEX_EDGES 8u

// In the model `accurate`, spheres have few contacts with one smooth part of a mesh (scene::Mesh::smoothOf).
#define SMOOTH_COSINE 0.9659f  // of 15 degrees: between two faces that are joined by an edge of less than 10
#define KEYS_PER_GROUP 4u      // of contacts with one smooth part of a mesh, in different directions
