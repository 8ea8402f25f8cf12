const float far_away = 1e37;  // [m] and beyond: an infinite ray (far_away of gpu/raster/first_hits.h)
