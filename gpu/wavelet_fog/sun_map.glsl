// The map of columns towards a sun: methods/wavelet_fog/sun_map.h. SUN_MAP_ACCESS: readonly or writeonly.
layout(std430, binding = AT_TABLE) SUN_MAP_ACCESS buffer SunMap { vec4 sun_map[]; };  // of f, p f, f falling; and f there
uniform int sun_columns, sun_rows;
uniform double sun_along_u, sun_along_v;       // the azimuth over the map
uniform double sun_lo_p, sun_lo_q, sun_step;   // first entry and step [cells]
uniform double sun_climb;                      // scale heights per cell
