/** The framebuffer of the scene pass: colour, and depth that later passes can read. */
export class SceneTarget {
  readonly colour: WebGLTexture;
  readonly depth: WebGLTexture;
  private readonly plain: WebGLFramebuffer;
  private readonly sampled: WebGLFramebuffer | undefined;
  private readonly buffers: WebGLRenderbuffer[] = [];

  constructor(
    private readonly gl: WebGL2RenderingContext,
    readonly width: number,
    readonly height: number,
    samples: number,
  ) {
    this.colour = texture(gl, gl.RGBA8, width, height, gl.LINEAR);
    this.depth = texture(gl, gl.DEPTH_COMPONENT24, width, height, gl.NEAREST);
    this.plain = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.plain);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.colour, 0);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.depth, 0);
    if (samples === 0) return;
    this.sampled = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.sampled);
    for (const [attachment, format] of [
      [gl.COLOR_ATTACHMENT0, gl.RGBA8],
      [gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT24],
    ] as const) {
      const buffer = gl.createRenderbuffer();
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, format, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, buffer);
      this.buffers.push(buffer);
    }
  }

  begin(): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.sampled ?? this.plain);
    gl.viewport(0, 0, this.width, this.height);
    gl.clear(gl.DEPTH_BUFFER_BIT);
  }

  /** Resolves the samples. */
  end(): void {
    const { gl, width, height } = this;
    if (!this.sampled) return;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.sampled);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, this.plain);
    const parts = gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT;
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, parts, gl.NEAREST);
  }

  free(): void {
    const { gl } = this;
    gl.deleteTexture(this.colour);
    gl.deleteTexture(this.depth);
    gl.deleteFramebuffer(this.plain);
    if (this.sampled) gl.deleteFramebuffer(this.sampled);
    for (const buffer of this.buffers) gl.deleteRenderbuffer(buffer);
  }
}

export function texture(
  gl: WebGL2RenderingContext,
  format: number,
  width: number,
  height: number,
  filter: number,
): WebGLTexture {
  const made = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, made);
  gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  return made;
}
