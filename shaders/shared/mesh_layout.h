// The words of a mesh in the buffer `obstacleLists`, behind the list of all obstacles. All addresses are numbers of words
// in this buffer. Coordinates are in the frame of the obstacle (m).
//
// The row of the obstacle has the grid. a.xyz is its lowest corner, and a.w the reciprocal of the width of its cells
// (1/m). b.xyz is the number of its cells along each axis, and b.w its reach (m). A cell knows all clusters of triangles
// within the reach of its points.
// `cellsAt` is the address of its cells, along x first. A cell is the address of two lists, one behind the other. The
// first has the clusters within NEAR_SHARE of the reach, for spheres that move little, the second has the others. A list
// is numbers of clusters in ascending order, then END_OF_LIST. A cell without clusters has EMPTY_CELL, and bits of a
// distance (m): no point of the cell is nearer to the mesh.
#define EMPTY_CELL 0x80000000u
#define NEAR_SHARE 0.63f

// Clusters, triangles and edges fill whole lines of a cache.
#define LINE_WORDS 16u

// `clustersAt` is the address of the clusters (sim/mesh_clusters.h). A cluster is between two planes. Across their normal,
// a box of its own is around each of its triangles. The boxes are on a grid of 255 by 255 steps around the centre.
#define CLUSTER_WORDS (2u * LINE_WORDS)
#define CLUSTER_NORMAL 0u     // of unit length
#define CLUSTER_LOW 3u        // m: the two planes, from the centre along the normal
#define CLUSTER_HIGH 4u
#define CLUSTER_CENTRE 5u     // m
#define CLUSTER_ACROSS 8u     // u, of unit length, across the normal; v is the cross product of the normal and u
#define CLUSTER_STEPS 11u     // per metre
#define CLUSTER_TRIANGLES 12u // address of the first triangle
#define CLUSTER_COUNT 13u     // of triangles, at most MOST_IN_CLUSTER
#define CLUSTER_BOXES LINE_WORDS  // of each triangle, in steps, a byte each: lowest u, highest u, lowest v, highest v
#define MOST_IN_CLUSTER 16u
#define STEPS_TO_CENTRE 127.5f

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
