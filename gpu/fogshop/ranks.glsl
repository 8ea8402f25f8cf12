// How many the invocations of the group before this one have. Every one must call it, once. Needs group_size.
shared int counts[group_size];

int rank_of(int local, int count) {
  counts[local] = count;
  for (int reach = 1; reach < group_size; reach *= 2) {  // sums of all up to here
    barrier();
    int before = local >= reach ? counts[local - reach] : 0;
    barrier();
    counts[local] += before;
  }
  return counts[local] - count;
}
