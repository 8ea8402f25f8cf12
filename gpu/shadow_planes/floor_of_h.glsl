// The light's distance from a ray, kept from 0 where the light lies on it outside a part that begins d0 [m] beyond the foot
// point (methods/shadow_planes/mapped_rule.h); 0 if it lies on the part.
float floor_of_h(float d0, float length_, float h) { return max(h, 1e-12 * min(abs(d0), abs(d0 + length_))); }
