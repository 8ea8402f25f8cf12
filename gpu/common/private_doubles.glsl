// Doubles in arrays of an invocation's own, as bits. NVIDIA's compiler (driver 580) rounds such arrays of doubles to single precision,
// without a word, where an index is known only at run time.
uvec2 bits_of(double x) { return unpackDouble2x32(x); }
double from_bits(uvec2 bits) { return packDouble2x32(bits); }
uvec4 bits_of(dvec2 v) { return uvec4(unpackDouble2x32(v.x), unpackDouble2x32(v.y)); }
dvec2 from_bits(uvec4 bits) { return dvec2(packDouble2x32(bits.xy), packDouble2x32(bits.zw)); }
