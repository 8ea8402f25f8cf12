// Random numbers of particles that come back: scene/math/random.h and scene/flow/random_points.cpp, bit for bit.
uvec4 philox(uvec4 c, uvec2 key) {
  for (int round_ = 0; round_ < 10; ++round_) {
    uint high_0, low_0, high_1, low_1;
    umulExtended(0xD2511F53u, c.x, high_0, low_0);
    umulExtended(0xCD9E8D57u, c.z, high_1, low_1);
    c = uvec4(high_1 ^ c.y ^ key.x, low_1, high_0 ^ c.w ^ key.y, low_0);
    key += uvec2(0x9E3779B9u, 0xBB67AE85u);
  }
  return c;
}

// In (0, 1), from 52 bits.
double fine(uint high, uint low) { return (double(high) * 1048576.0LF + double(low >> 12) + 0.5LF) / 4503599627370496.0LF; }

// Three, of particle i, drawn for the `times`-th time.
dvec3 random_shares(uint seed, uint i, uint times) {
  uvec2 key = uvec2(seed, 0x7074u);
  uvec4 one = philox(uvec4(i, times, 0, 0), key), two = philox(uvec4(i, times, 1, 0), key);
  return dvec3(fine(one.x, one.y), fine(one.z, one.w), fine(two.x, two.y));
}
