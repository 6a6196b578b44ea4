// WebGL: spheres, lines and the sky behind them.

const eye_source = `#version 300 es
precision highp float;
uniform mat3 u_turn;
uniform vec3 u_target;
uniform float u_distance;
uniform vec2 u_lens, u_shift, u_depth, u_size, u_fog;
uniform vec3 u_haze;
uniform float u_dense;
vec3 eye(vec3 p) { vec3 e = u_turn * (p - u_target); e.z -= u_distance; return e; }
vec4 clip(vec3 e) { return vec4(e.xy * u_lens - e.z * u_shift, e.z * u_depth.x + u_depth.y, -e.z); }
float pixels(float z) { return 0.5 * u_size.y * u_lens.y / max(-z, 1e-30); }
vec3 hazed(vec3 color, float z) { return mix(color, u_haze, u_dense * smoothstep(u_fog.x, u_fog.y, -z)); }
`;

const sky_sources = [`#version 300 es
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 1, 1); }`, `#version 300 es
precision highp float;
uniform vec2 u_size;
uniform vec3 u_sky, u_deep;
out vec4 color;
void main() {
  vec2 q = (gl_FragCoord.xy / u_size - vec2(0.5, 0.57)) * vec2(1.0, 1.15);
  float noise = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453);  // no bands
  color = vec4(mix(u_sky, u_deep, smoothstep(0.0, 0.72, length(q))) + (noise - 0.5) / 255.0, 1);
}`];

const sphere_sources = [eye_source + `
in vec3 place;
in vec4 paint;    // color, and whether it shines by itself
in float radius;  // in pixels, or in units of length
uniform float u_in_pixels, u_least, u_glow;
out vec4 v_paint;
out vec3 v_eye;
out vec2 v_radius;
void main() {
  vec3 e = eye(place);
  float scale = pixels(e.z);
  float size = u_in_pixels > 0.0 ? radius * u_in_pixels : max(radius * scale, u_least);
  if (u_glow > 0.0) size *= paint.a > 0.5 ? u_glow : 0.0;
  v_radius = vec2(size, size / scale);
  v_eye = e;
  v_paint = paint;
  gl_Position = e.z < 0.0 && size > 0.0 ? clip(e) : vec4(2, 2, 2, 1);
  gl_PointSize = 2.0 * size + 1.0;
}`, eye_source + `
in vec4 v_paint;
in vec3 v_eye;
in vec2 v_radius;
uniform float u_glow;
out vec4 color;
void main() {
  vec2 q = (gl_PointCoord * 2.0 - 1.0) * vec2(1, -1) * (v_radius.x + 0.5) / v_radius.x;
  float r = length(q);
  if (u_glow > 0.0) {
    float halo = pow(max(0.0, 1.0 - r), 2.6);
    color = vec4(v_paint.rgb * halo * 0.75, 0);
    gl_FragDepth = gl_FragCoord.z;
    return;
  }
  float cover = clamp((1.0 - r) * v_radius.x + 0.5, 0.0, 1.0);
  if (cover <= 0.0) discard;
  float z = sqrt(max(0.0, 1.0 - r * r));
  vec3 normal = vec3(q, z), light = normalize(vec3(-0.45, 0.62, 0.72));
  float lit = max(0.0, dot(normal, light)), shine = pow(max(0.0, dot(normal, normalize(light + vec3(0, 0, 1)))), 48.0);
  vec3 shaded = v_paint.rgb * (0.30 + 0.78 * lit) * (0.72 + 0.28 * z) + 0.28 * shine;
  shaded = mix(shaded, mix(v_paint.rgb, vec3(1), 0.55 * z * z), v_paint.a);
  float depth = v_eye.z + z * v_radius.y;
  color = vec4(hazed(shaded, v_eye.z), cover);
  gl_FragDepth = clamp(0.5 - 0.5 * (u_depth.x + u_depth.y / depth), 0.0, 1.0);
}`];

const line_sources = [eye_source + `
in vec4 a, b;                // ends: place and time
in vec4 a_paint, b_paint;
uniform float u_width, u_thick, u_now, u_length, u_floor;  // pixels, length; times of what fades
out vec4 v_paint;
out vec3 v_across;           // from -1 to 1, half the width in pixels, depth
float faded(float t) {
  if (u_length <= 0.0) return 1.0;
  float left = clamp(1.0 - (u_now - t) / u_length, 0.0, 1.0);
  return left <= 0.0 ? u_floor : max(u_floor, left * sqrt(left));
}
void main() {
  vec4 begin = a, end = b;
  gl_Position = vec4(2, 2, 2, 1);
  if (u_length > 0.0) {
    if (begin.w >= u_now) return;
    if (end.w > u_now) end = mix(begin, end, (u_now - begin.w) / (end.w - begin.w));
  }
  vec3 p = eye(begin.xyz), q = eye(end.xyz);
  float near = -1e-3 * u_distance;
  if (p.z >= near && q.z >= near) return;
  if (p.z > near) p = mix(q, p, (near - q.z) / (p.z - q.z));
  if (q.z > near) q = mix(p, q, (near - p.z) / (q.z - p.z));
  bool last = gl_VertexID > 1;
  vec4 from = clip(p), to = clip(q), here = last ? to : from;
  vec2 way = (to.xy / to.w - from.xy / from.w) * u_size;
  float size = length(way);
  way = size > 1e-6 ? way / size : vec2(1, 0);
  float z = last ? q.z : p.z, half_width = 0.5 * max(u_width, u_thick * pixels(z)), reach = half_width + 1.0;
  float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
  vec2 off = vec2(-way.y, way.x) * side * reach;
  v_across = vec3(side * reach / half_width, half_width, z);
  v_paint = last ? b_paint : a_paint;
  v_paint.a *= faded(last ? end.w : begin.w);
  gl_Position = here + vec4(off * 2.0 / u_size * here.w, 0, 0);
}`, eye_source + `
in vec4 v_paint;
in vec3 v_across;
uniform float u_round;
out vec4 color;
void main() {
  float s = abs(v_across.x), cover = clamp((1.0 - s) * v_across.y + 0.5, 0.0, 1.0);
  float lit = u_round > 0.0 ? 0.35 + 0.65 * sqrt(max(0.0, 1.0 - s * s)) : 1.0;
  if (cover * v_paint.a <= 0.004) discard;
  color = vec4(hazed(v_paint.rgb * lit, v_across.z), v_paint.a * cover);
}`];

class Picture {
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: false });
    if (!gl) throw new Error("This browser does not support WebGL 2, which draws the picture. Switch on its hardware acceleration, or try a newer browser.");
    this.gl = gl, this.canvas = canvas;
    this.sky = this.program(sky_sources), this.spheres = this.program(sphere_sources), this.lines = this.program(line_sources);
    this.empty = gl.createVertexArray();
    this.points = this.layout(this.spheres, [["place", 3], ["paint", 4], ["radius", 1]], 0);
    this.changing = this.layout(this.lines, [["a", 4], ["b", 4], ["a_paint", 4], ["b_paint", 4]], 1);
  }
  program([vertex, fragment]) {
    const { gl } = this, program = gl.createProgram(), uniforms = {};
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    for (let k = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); k-- > 0;) {
      const { name } = gl.getActiveUniform(program, k);
      uniforms[name] = gl.getUniformLocation(program, name);
    }
    return { program, uniforms };
  }
  // A buffer of rows of numbers, and how the attributes of a program read it.
  layout(program, attributes, divisor) {
    const { gl } = this, array = gl.createVertexArray(), buffer = gl.createBuffer();
    const stride = attributes.reduce((sum, [, width]) => sum + width, 0);
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    let offset = 0;
    for (const [name, width] of attributes) {
      const at = gl.getAttribLocation(program.program, name);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, width, gl.FLOAT, false, 4 * stride, 4 * offset);
      gl.vertexAttribDivisor(at, divisor);
      offset += width;
    }
    return { array, buffer, stride };
  }
  // A line through points (x, y, z, time): each piece begins where the one before ends.
  path(points) {
    const { gl } = this, array = gl.createVertexArray(), buffer = gl.createBuffer();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, points, gl.STATIC_DRAW);
    for (const name of ["a", "b"]) gl.enableVertexAttribArray(gl.getAttribLocation(this.lines.program, name));
    return { array, buffer, pieces: points.length / 4 - 1 };
  }
  forget(path) {
    this.gl.deleteVertexArray(path.array);
    this.gl.deleteBuffer(path.buffer);
  }
  use(program, camera) {
    const { gl } = this, u = program.uniforms;
    gl.useProgram(program.program);
    gl.uniformMatrix3fv(u.u_turn, true, camera.turn.flat());
    gl.uniform1f(u.u_distance, camera.distance);
    gl.uniform2f(u.u_lens, camera.lens * this.canvas.height / this.canvas.width, camera.lens);
    gl.uniform2f(u.u_shift, ...camera.shift);
    const near = Math.max(camera.distance * 1e-3, camera.distance - 4 * camera.reach), far = camera.distance + 4 * camera.reach;
    gl.uniform2f(u.u_depth, -(far + near) / (far - near), -2 * far * near / (far - near));
    gl.uniform2f(u.u_size, this.canvas.width, this.canvas.height);
    gl.uniform2f(u.u_fog, camera.distance - camera.reach, camera.distance + 1.15 * camera.reach);
    gl.uniform3f(u.u_haze, ...camera.haze);
    gl.uniform1f(u.u_dense, camera.dense);
    gl.uniform3f(u.u_target, ...camera.target);
    return u;
  }
  begin(camera) {
    const { gl, canvas } = this;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.depthMask(true);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.disable(gl.DEPTH_TEST), gl.disable(gl.BLEND);
    gl.useProgram(this.sky.program);
    gl.uniform2f(this.sky.uniforms.u_size, canvas.width, canvas.height);
    gl.uniform3f(this.sky.uniforms.u_sky, ...camera.sky);
    gl.uniform3f(this.sky.uniforms.u_deep, ...camera.deep);
    gl.bindVertexArray(this.empty);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
  }
  // Rows of place, color, whether it shines, radius. @param glow  of those that shine: their halo in radii, or 0
  draw_spheres(rows, camera, in_pixels, glow) {
    const { gl } = this, u = this.use(this.spheres, camera);
    gl.uniform1f(u.u_in_pixels, in_pixels);
    gl.uniform1f(u.u_least, 1.3 * devicePixelRatio);
    gl.uniform1f(u.u_glow, glow);
    gl.uniform3f(u.u_target, 0, 0, 0);  // places are given from there
    gl.bindVertexArray(this.points.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.points.buffer);
    if (glow > 0) {
      gl.enable(gl.BLEND), gl.blendFunc(gl.ONE, gl.ONE), gl.depthMask(false);
    } else {
      gl.bufferData(gl.ARRAY_BUFFER, rows, gl.DYNAMIC_DRAW);
      gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE), gl.depthMask(true);
    }
    gl.drawArrays(gl.POINTS, 0, rows.length / this.points.stride);
    gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE), gl.disable(gl.BLEND);
  }
  line_style(camera, { width = 0, thick = 0, now = 0, length = 0, floor = 0, round = 0 }) {
    const { gl } = this, u = this.use(this.lines, camera);
    const numbers = { u_width: width * devicePixelRatio, u_thick: thick, u_now: now, u_length: length, u_floor: floor, u_round: round };
    for (const [name, value] of Object.entries(numbers)) gl.uniform1f(u[name], value);
    if (round > 0) {
      gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE), gl.disable(gl.BLEND), gl.depthMask(true);
    } else {
      gl.enable(gl.BLEND), gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA), gl.depthMask(false);
    }
  }
  // Rows of two ends (place and time) and their two colors.
  draw_lines(rows, camera, style) {
    const { gl } = this;
    if (rows.length === 0) return;
    this.line_style(camera, style);
    gl.bindVertexArray(this.changing.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.changing.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, rows, gl.DYNAMIC_DRAW);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, rows.length / this.changing.stride);
    gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
  }
  // Pieces [first, end) of a path, in one color.
  draw_path(path, first, end, color, camera, style) {
    const { gl } = this, program = this.lines.program;
    if (end <= first) return;
    this.line_style(camera, style);
    gl.bindVertexArray(path.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, path.buffer);
    ["a", "b"].forEach((name, k) => {
      const at = gl.getAttribLocation(program, name);
      gl.vertexAttribPointer(at, 4, gl.FLOAT, false, 16, 16 * (first + k));
      gl.vertexAttribDivisor(at, 1);
      gl.vertexAttrib4f(gl.getAttribLocation(program, name + "_paint"), ...color);
    });
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, end - first);
  }
}
