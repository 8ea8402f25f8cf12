// A Gaussian along a ray: amplitude * exp(-(near2 + ((t - middle) * rate)^2)), for |t - middle| <= spread.
struct Profile {
  bool met;
  float middle, rate, near2, spread;
};
Profile profile(Gaussian g, vec3 o, vec3 d) {
  Profile p;
  vec3 q = g.inverse_width * (g.center - o), w = g.inverse_width * d;
  float rate2 = dot(w, w);
  p.rate = sqrt(rate2);
  p.middle = dot(q, w) / rate2;
  vec3 away = q - p.middle * w;  // not |q|^2 less its part along the ray, which loses all digits far away
  p.near2 = dot(away, away);
  p.met = p.near2 <= g.limit;
  p.spread = sqrt(max(0, g.limit - p.near2)) / p.rate;
  return p;
}
