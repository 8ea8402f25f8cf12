// The lights of a solve (channels of colour that have extinction and albedo in common) and what scatters them.
uniform int first_light, lights;  // in buffers of all lights
uniform int channel[3];           // of each of them
uniform vec3 sigma_t, albedo;
uniform float moment[BANDS];      // of the phase function: that of its band, for each coefficient
