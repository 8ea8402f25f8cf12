// Maps of columns towards a sun, one for each medium and one after the other: methods/wavelet_fog/sun_map.h. SUN_MAP_ACCESS: readonly
// or writeonly. Needs fog.glsl.
layout(std430, binding = AT_TABLE) SUN_MAP_ACCESS buffer SunMap { vec4 sun_map[]; };  // of f, p f, f falling; and f there
uniform int sun_columns[MEDIA], sun_rows[MEDIA], sun_first[MEDIA];      // first: entry
uniform double sun_along_u[MEDIA], sun_along_v[MEDIA];                  // the azimuth over the map
uniform double sun_lo_p[MEDIA], sun_lo_q[MEDIA];                        // first entry [cells]
uniform double sun_climb[MEDIA];                                        // scale heights per cell
uniform double sun_step;                                                // [cells]
