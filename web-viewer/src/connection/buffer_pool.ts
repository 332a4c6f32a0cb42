const capacity = 4; // spare buffers

/** Reuses the buffers of states that the page has returned, so that decoding a frame allocates nothing. */
export class BufferPool {
  private readonly spare: ArrayBuffer[] = [];

  /** Returns a buffer of at least `bytes` bytes; its content is undefined. */
  acquire(bytes: number): ArrayBuffer {
    const used = this.spare.pop();
    return used && used.byteLength >= bytes ? used : new ArrayBuffer(bytes);
  }

  release(buffer: ArrayBuffer): void {
    if (this.spare.length < capacity) this.spare.push(buffer);
  }
}
