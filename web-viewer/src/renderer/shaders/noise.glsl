// A number in 0..1 that differs from pixel to pixel, after Jimenez 2014 ("interleaved gradient noise").
float noise() { return fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))); }
