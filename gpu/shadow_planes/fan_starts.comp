// Where the list of every sector begins and ends, in no order: a work group takes room for its sectors.
layout(local_size_x = LOCAL_SIZE_X) in;

layout(std430, binding = AT_SECTORS) buffer Sectors { int listed, sector_count[]; };
layout(std430, binding = AT_STARTS) writeonly buffer Starts { ivec2 sector_list[]; };

shared int of_group, first_of_group;

void main() {
  int sector = int(gl_GlobalInvocationID.x);
  if (gl_LocalInvocationID.x == 0) of_group = 0;
  barrier();
  int count = sector < FAN_SECTORS ? sector_count[sector] : 0, before = count > 0 ? atomicAdd(of_group, count) : 0;
  barrier();
  if (gl_LocalInvocationID.x == 0) first_of_group = of_group > 0 ? atomicAdd(listed, of_group) : 0;
  barrier();
  if (sector < FAN_SECTORS) sector_list[sector] = first_of_group + before + ivec2(0, count);
}
