// Half floats and sRGB: what the comparer of the report and the page of `airlight serve` share.
"use strict";

const halfTable = (() => {
  const table = new Float32Array(65536);
  for (let i = 0; i < 65536; ++i) {
    const sign = i & 0x8000 ? -1 : 1, exponent = (i >> 10) & 31, fraction = i & 1023;
    table[i] = sign * (exponent === 0 ? fraction * 2 ** -24
      : exponent === 31 ? (fraction ? NaN : Infinity) : (1 + fraction / 1024) * 2 ** (exponent - 15));
  }
  return table;
})();

// A linear value as a byte of sRGB; above 1 it is cut off.
const toSrgb = (() => {
  const table = new Uint8ClampedArray(65537);
  for (let i = 0; i <= 65536; ++i) {
    const v = i / 65536;
    table[i] = Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055));
  }
  return v => table[v >= 1 ? 65536 : v > 0 ? (v * 65536 + 0.5) | 0 : 0];
})();
