import { capacity } from "../model/trace";
import type { Trace } from "../model/trace";
import { program, slot } from "./program";
import type { Program } from "./program";
import frame from "./shaders/frame.glsl";
import fragment from "./shaders/trace.frag.glsl";
import vertex from "./shaders/trace.vert.glsl";

const segmentBytes = 24;
const halfWidth = 1.25; // CSS pixels

/** Draws the path of a sphere. Uploads the segments that are new. */
export class TracePass {
  private readonly used: Program;
  private readonly array: WebGLVertexArrayObject;
  private readonly buffer: WebGLBuffer;
  private run = -1; // of the path on the device
  private uploaded = 0; // segments of it

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.used = program(gl, [frame, vertex], [fragment]);
    this.array = gl.createVertexArray();
    this.buffer = gl.createBuffer();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, segmentBytes * capacity, gl.DYNAMIC_DRAW);
    for (const [name, offset] of [
      ["a_position", 0],
      ["a_normal", 12],
    ] as const) {
      gl.enableVertexAttribArray(slot(name));
      gl.vertexAttribPointer(slot(name), 3, gl.FLOAT, false, segmentBytes, offset);
      gl.vertexAttribDivisor(slot(name), 1);
    }
    gl.bindVertexArray(null);
  }

  /** `scale`: pixels per CSS pixel. */
  draw(trace: Trace, scale: number): void {
    if (!trace.known) return;
    const { gl, used } = this;
    this.upload(trace);
    used.use();
    gl.enable(gl.BLEND);
    gl.depthMask(false);
    gl.uniform1f(used.at("u_halfWidth"), halfWidth * scale);
    gl.uniform1f(used.at("u_total"), trace.length);
    gl.bindVertexArray(this.array);
    const begin = Math.max(0, trace.length - capacity);
    const wrap = trace.length - (trace.length % capacity); // number of the segment at the begin of the buffer
    if (begin < wrap) this.drawPart(begin % capacity, begin, wrap - begin);
    this.drawPart(0, wrap, trace.length - wrap);
    gl.bindVertexArray(null);
    const [x, y, z] = trace.last;
    gl.vertexAttrib3f(slot("a_position"), x, y, z);
    gl.vertexAttrib3f(slot("a_normal"), ...trace.end);
    gl.uniform1f(used.at("u_first"), trace.length);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, 1);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  /** Draws consecutive segments, the first of which lies at `at` in the buffer. */
  private drawPart(at: number, first: number, count: number): void {
    const { gl, used } = this;
    if (count === 0) return;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.vertexAttribPointer(slot("a_position"), 3, gl.FLOAT, false, segmentBytes, segmentBytes * at);
    gl.vertexAttribPointer(slot("a_normal"), 3, gl.FLOAT, false, segmentBytes, segmentBytes * at + 12);
    gl.uniform1f(used.at("u_first"), first);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
  }

  private upload({ segments, length, run }: Trace): void {
    const { gl } = this;
    if (run !== this.run) this.uploaded = 0;
    this.run = run;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    for (let k = Math.max(this.uploaded, length - capacity); k < length; k++) {
      const at = k % capacity;
      gl.bufferSubData(gl.ARRAY_BUFFER, segmentBytes * at, segments, 6 * at, 6);
    }
    this.uploaded = length;
  }
}
