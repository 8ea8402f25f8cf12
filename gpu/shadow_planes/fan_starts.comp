// Where the list of every sector begins: sums of the counts before it, which become 0. One work group.
layout(local_size_x = LOCAL_SIZE_X) in;

layout(std430, binding = 1) buffer SectorCounts { int sector_count[]; };
layout(std430, binding = 3) writeonly buffer Starts { int starts[]; };  // and the end of the last
uniform int total_sectors;

shared int sums[LOCAL_SIZE_X];

void main() {
  int thread = int(gl_LocalInvocationID.x), share = (total_sectors + LOCAL_SIZE_X - 1) / LOCAL_SIZE_X;
  int first = min(total_sectors, thread * share), last = min(total_sectors, first + share), sum = 0;
  for (int i = first; i < last; ++i) sum += sector_count[i];
  sums[thread] = sum;
  barrier();
  int start = 0;
  for (int i = 0; i < thread; ++i) start += sums[i];
  for (int i = first; i < last; ++i) {
    starts[i] = start;
    start += sector_count[i];
    sector_count[i] = 0;
  }
  if (thread == LOCAL_SIZE_X - 1) starts[total_sectors] = start;
}
