// Slabs of one index x, a work group each: room for one before and after products along z. Lanes are rows, for products along z, or
// columns, for those along y. In two dimensions nothing is along z: a matrix that begins with 1.
#include "legendre_fluids/fields.glsl"
#define FOURS_Z (D == 3 ? FOURS : 1)
#define SQUARE_FOURS_Z (D == 3 ? SQUARE_FOURS : 1)
#define ROOM (POINTS * POINTS_Z > SLAB ? POINTS * POINTS_Z : SLAB)
#define WORK (2 * ROOM)
#include "legendre_fluids/line.glsl"
#define lane int(gl_LocalInvocationID.x)
