// Sums over the lanes of a work group, of three channels with cosines and with sines.
#define lane int(gl_LocalInvocationIndex)
shared double sums[6 * LOCAL_SIZE_X];
double sum_of_lanes(dvec3 even, dvec3 odd) {  // the sum of the lane's channel, for the first six lanes
  for (int c = 0; c < 3; ++c) {
    sums[c * LOCAL_SIZE_X + lane] = even[c];
    sums[(3 + c) * LOCAL_SIZE_X + lane] = odd[c];
  }
  barrier();
  double sum = 0;
  if (lane < 6)
    for (int k = 0; k < LOCAL_SIZE_X; ++k) sum += sums[lane * LOCAL_SIZE_X + k];
  return sum;
}
