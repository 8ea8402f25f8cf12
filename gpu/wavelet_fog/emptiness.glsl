// For each cell of the map in 4 bits, 8 cells a word: 0 if there is something in it, else 1 + the level of the largest empty block
// around it. EMPTINESS_ACCESS: readonly or writeonly.
layout(std430, binding = AT_EMPTINESS) EMPTINESS_ACCESS buffer Emptiness { uint emptiness[]; };

int words_in_row(Grid cells) { return (cells.size_u + 7) / 8; }
