// Coefficients of the fluid on the device: fields of SIZE numbers, [x][y][z], the D components of the velocity first, then what it carries.
// A component has N numbers along its own axis too, those of phi_0 = 0 first: 0. D, N, NZ (N, in two dimensions 1), POINTS, POINTS_Z,
// ROW and SQUARE_ROW (POINTS and N filled up to a multiple of 4) and FIELDS are definitions.
#define SLAB (N * NZ)
#define SIZE (N * SLAB)
#define LINES (POINTS * POINTS_Z)

// Matrices by rows, four numbers at a time: tables.h says which, and where each begins. The matrix for L is followed by the one for
// phi. They are uniform, so all lines that are multiplied should read one entry at a time: each line belongs to one invocation.
layout(std140, binding = AT_MATRICES) uniform Matrices { vec4 matrices[MATRICES]; };
#define FOURS (ROW / 4)
#define SQUARE_FOURS (SQUARE_ROW / 4)

// Start of a field's matrix along an axis: the one for phi along the component's own axis, else the one for L.
int basis_at(int table, int field, int axis) { return table + (field == axis ? N * FOURS : 0); }
int modes_at(int field, int axis) { return field == axis ? TABLE_WALL_MODES : TABLE_FREE_MODES; }
float number(int table, int at) { return matrices[table + at / 4][at % 4]; }
