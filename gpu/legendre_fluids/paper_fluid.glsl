// Fields of the paper's fluid in double precision (methods/legendre_fluids/paper_fluid.h): N N NZ coefficients of L each, [x][y][z], first
// the D components of the velocity, then what it carries. Products are taken at M points of each axis. Tables are matrices by columns.
// paper_fluid.cpp defines where they and the parts of `work` begin.
layout(local_size_x = LOCAL_SIZE_X) in;
layout(std430, binding = AT_TABLES) readonly buffer Tables { double tables[]; };
layout(std430, binding = AT_STATE) coherent buffer State { double state[]; };
layout(std430, binding = AT_WORK) coherent buffer Work { double work[]; };
layout(std430, binding = AT_STATUS) coherent buffer Status { double status[]; };
#include "legendre_fluids/tensors.glsl"
#define SLAB (N * NZ)
#define SIZE (N * SLAB)
#define MZ (D == 3 ? M : 1)
#define ALL_POINTS (M * M * MZ)
#define REGIONS_OF_SOURCES REGIONS_AT
#define REGIONS_OF_PUSHES (REGIONS_AT + SOURCES * SIZE)

// Status of a field.
#define STATUS_OF(field, i) status[(field) * FIELD_STATUS + i]
#define GREATEST(field) STATUS_OF(field, 0)  // |u| at the points
#define LOST(field) STATUS_OF(field, 1)      // some coefficient is no finite number
#define DONE(field) STATUS_OF(field, 2)      // the series has ended
#define STEPS(field) STATUS_OF(field, 3)     // of the series so far: terms, and ends of parts
#define PART(field) STATUS_OF(field, 4)      // of the step
#define NEXT(field) STATUS_OF(field, 5)      // number of the term that is next; 0: the part begins
#define SMALL(field) STATUS_OF(field, 6)     // norm below which terms end the part
#define NORM(field) STATUS_OF(field, 7)      // of the last term
#define SQUARES(field) STATUS_OF(field, 8)   // sum of the squared coefficients at first
// Energies, over half the box's volume: after advection and diffusion, before and after the last projection.
#define ENERGY(i) status[FIELDS * FIELD_STATUS + i]
#define LOST_AT_END status[FIELDS * FIELD_STATUS + 3]
bool is_lost(double x) { return (unpackDouble2x32(x).y & 0x7ff00000u) == 0x7ff00000u; }

// Axis a of coefficient e: its index there, and the distance of neighbours.
int stride_of(int a) { return a == 0 ? SLAB : a == 1 ? NZ : 1; }
int index_of(int e, int a) { return a == 0 ? e / SLAB : a == 1 ? e / NZ % N : e % NZ; }
