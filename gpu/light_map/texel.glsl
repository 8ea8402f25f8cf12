// Texels of a map that a dispatch is about, counted row by row with the border.
uniform int map_size;                  // texels a side, without the border
uniform int first_texel, texel_count;  // of the dispatch
uniform int steps;                     // along a texel's ray

// The texel within the map that a texel of the border repeats: the octahedron's edges meet themselves, their halves exchanged;
// other maps end there. LightMap::make_border.
uniform int whole_sphere;
ivec2 texel_at(int place) {
  ivec2 at = ivec2(place % (map_size + 2), place / (map_size + 2)) - 1;
  for (int a = 0; a < 2; ++a)
    if (at[a] < 0 || at[a] >= map_size) {
      at[a] = clamp(at[a], 0, map_size - 1);
      if (whole_sphere != 0) at[1 - a] = map_size - 1 - at[1 - a];
    }
  return at;
}
