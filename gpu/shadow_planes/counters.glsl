// Counters of a frame. Every dispatch that may leave pixels unfinished writes the group counts of the dispatch that continues them. The
// first entry is for pixels that no dispatch has continued.
layout(std430, binding = AT_COUNTERS) buffer Counters {
  uint lit_parts, crossings, gatherings_after_first;
  uint loops_were_cut;  // the picture is wrong (common/loops_cut.glsl)
  uint values_missing;  // there was no room for those of so many silhouette edges
  uint unused[3];
  uvec4 resume_groups[];
};
