// Coefficients of the fluid on the device: fields of SIZE numbers, [x][y][z], the D components of the velocity first, then what it carries.
// A component has N numbers along its own axis too, those of phi_0 = 0 first: 0. D, N, NZ (N, in two dimensions 1), POINTS, POINTS_Z,
// ROW and SQUARE_ROW (POINTS and N filled up to a multiple of 4) and FIELDS are definitions.
#define SLAB (N * NZ)
#define SIZE (N * SLAB)
#define LINES (POINTS * POINTS_Z)

// Matrices by rows, four numbers at a time: tables.h says which, and where each begins. Those of L and of phi stand one after the other.
// They are uniform, so all lines that are multiplied should ask for the same entry at a time: a line is an invocation's.
layout(std140, binding = AT_MATRICES) uniform Matrices { vec4 matrices[MATRICES]; };
#define FOURS (ROW / 4)
#define SQUARE_FOURS (SQUARE_ROW / 4)

// Where that of a field along an axis begins: of phi along its own, else of L.
int basis_at(int table, int field, int axis) { return table + (field == axis ? N * FOURS : 0); }
int modes_at(int field, int axis) { return field == axis ? TABLE_WALL_MODES : TABLE_FREE_MODES; }
float number(int table, int at) { return matrices[table + at / 4][at % 4]; }
