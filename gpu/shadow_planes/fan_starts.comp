// Where the list of every sector begins and ends, in no order: a work group takes room for its sectors.
layout(local_size_x = LOCAL_SIZE_X) in;

layout(std430, binding = AT_SECTORS) buffer Sectors { int listed, sector_count[]; };
layout(std430, binding = AT_LISTS) writeonly buffer Lists {
  ivec2 sector_list[FAN_SECTORS];
  int lists[];
};

shared int of_group, first_of_group;

void main() {
  int first = int(gl_WorkGroupID.x) * SECTORS_PER_GROUP + int(gl_LocalInvocationID.x), count = 0;
  int last = min(FAN_SECTORS, (int(gl_WorkGroupID.x) + 1) * SECTORS_PER_GROUP);
  if (gl_LocalInvocationID.x == 0) of_group = 0;
  barrier();
  for (int sector = first; sector < last; sector += LOCAL_SIZE_X) count += sector_count[sector];
  int begin = count > 0 ? atomicAdd(of_group, count) : 0;
  barrier();
  if (gl_LocalInvocationID.x == 0) first_of_group = of_group > 0 ? atomicAdd(listed, of_group) : 0;
  barrier();
  begin += first_of_group;
  for (int sector = first; sector < last; sector += LOCAL_SIZE_X) {
    int end = begin + sector_count[sector];
    sector_list[sector] = ivec2(begin, end);
    begin = end;
  }
}
