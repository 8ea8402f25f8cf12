// 1 - exp(-depth) without the digits that the difference loses in thin fog.
float opacity(float depth) {
  return depth > 0.125 ? 1 - exp(-depth) : depth * (1 - depth / 2 * (1 - depth / 3 * (1 - depth / 4 * (1 - depth / 5))));
}
