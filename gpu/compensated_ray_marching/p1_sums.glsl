// Sums over all cells, of each system of a solve: a part for each work group, added up by whoever needs them in the next dispatch.
layout(std430, binding = AT_PARTS) buffer Parts { double parts[]; };  // [system of the solve][SUMS][group]
uniform int groups;                                    // at most LOCAL_SIZE_X
shared double together[LOCAL_SIZE_X];
#define SUM_OF_RIGHT 0    // squares of the right side
#define SUM_OF_ALONG 1    // direction times the matrix times direction
#define SUM_OF_SQUARES 2  // of the residual
#define SUM_OF_SCALED 3   // residual times inverse times residual; two, of even and odd iterations

// Sum over all lanes of the work group.
double total(double mine) {
  barrier();
  together[lane] = mine;
  barrier();
  for (int half_way = LOCAL_SIZE_X / 2; half_way > 0; half_way /= 2) {
    if (lane < half_way) together[lane] += together[lane + half_way];
    barrier();
  }
  return together[0];
}
int part_of(int which, int group) { return (int(gl_WorkGroupID.z) * SUMS + which) * groups + group; }
void keep(int which, double mine) {
  double sum = total(mine);
  if (lane == 0) parts[part_of(which, int(gl_WorkGroupID.x))] = sum;
}
double sum_of(int which) { return total(lane < groups ? parts[part_of(which, lane)] : 0.0LF); }
