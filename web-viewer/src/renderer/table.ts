import type { Run } from "../model/population";

/** Texels per row of a table; shaders/spheres.glsl has the same number. Every device has textures of this width. */
const width = 2048;

type Values = Float32Array | Int32Array | Uint32Array;

/** A table on the device: a texture with one texel per place, row after row. */
export class Table {
  texture: WebGLTexture;
  private rows = 0;

  /** `components`: values per place. `whole`: they are integers, one without or three with a sign; else floats. */
  constructor(
    private readonly gl: WebGL2RenderingContext,
    private readonly components: 1 | 3 | 4,
    private readonly whole = false,
  ) {
    this.texture = this.create(1, 1);
  }

  /** Makes room for this number of places. The values are then undefined if the number of rows changes. */
  fit(places: number): void {
    const rows = Math.max(1, Math.ceil(places / width));
    if (rows === this.rows) return;
    this.gl.deleteTexture(this.texture);
    this.texture = this.create(width, rows);
    this.rows = rows;
  }

  /** Uploads the values of these places. `values`: of all places, from place 0 on. */
  upload(values: Values, { first, count }: Run): void {
    const { gl, components } = this;
    const [format, type] = this.layout();
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    const end = Math.min(first + count, values.length / components);
    for (let place = first; place < end;) {
      const x = place % width;
      const isRow = x === 0 && end - place >= width;
      const columns = isRow ? width : Math.min(width - x, end - place);
      const rows = isRow ? Math.floor((end - place) / width) : 1;
      const y = Math.floor(place / width);
      gl.texSubImage2D(gl.TEXTURE_2D, 0, x, y, columns, rows, format, type, values, components * place);
      place += columns * rows;
    }
  }

  private layout(): [format: number, type: number, stored: number] {
    const { gl, components } = this;
    if (this.whole && components === 3) return [gl.RGB_INTEGER, gl.INT, gl.RGB32I];
    if (this.whole) return [gl.RED_INTEGER, gl.UNSIGNED_INT, gl.R32UI];
    if (components === 1) return [gl.RED, gl.FLOAT, gl.R32F];
    return components === 3 ? [gl.RGB, gl.FLOAT, gl.RGB32F] : [gl.RGBA, gl.FLOAT, gl.RGBA32F];
  }

  private create(columns: number, rows: number): WebGLTexture {
    const { gl } = this;
    const [, , stored] = this.layout();
    return texture(gl, stored, columns, rows, gl.NEAREST);
  }
}

export function texture(
  gl: WebGL2RenderingContext,
  format: number,
  columns: number,
  rows: number,
  filter: number,
): WebGLTexture {
  const made = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, made);
  gl.texStorage2D(gl.TEXTURE_2D, 1, format, columns, rows);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  return made;
}
