import type { Vec3 } from "../model/facts";
import { slot } from "./program";
import { vertexFloats } from "./shapes";
import type { Vertices } from "./shapes";

/** A vertex buffer on the device, with its layout. */
export class Mesh {
  private readonly array: WebGLVertexArrayObject;
  private readonly buffer: WebGLBuffer;
  private count = 0;

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.array = gl.createVertexArray();
    this.buffer = gl.createBuffer();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    const stride = 4 * vertexFloats;
    for (const [name, size, offset] of [
      ["a_position", 3, 0],
      ["a_normal", 3, 12],
      ["a_colour", 4, 24],
    ] as const) {
      gl.enableVertexAttribArray(slot(name));
      gl.vertexAttribPointer(slot(name), size, gl.FLOAT, false, stride, offset);
    }
    gl.bindVertexArray(null);
  }

  /** `origin`: positions on the device are relative to it (m). */
  set(vertices: Vertices, origin: Vec3): void {
    this.count = vertices.length / vertexFloats;
    const near = Float32Array.from(vertices, (value, i) => value - (origin[i % vertexFloats] ?? 0));
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.buffer);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, near, this.gl.STATIC_DRAW);
  }

  draw(mode: number = this.gl.TRIANGLES): void {
    if (this.count === 0) return;
    this.gl.bindVertexArray(this.array);
    this.gl.drawArrays(mode, 0, this.count);
    this.gl.bindVertexArray(null);
  }

  free(): void {
    this.gl.deleteVertexArray(this.array);
    this.gl.deleteBuffer(this.buffer);
  }
}
