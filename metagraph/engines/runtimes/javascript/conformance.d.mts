/** Run conformance vectors. `passed`: how many cases. */
export function runVectors(
  vectors: object,
  exportJson: string,
  glbBytes: Uint8Array | ArrayBuffer,
): { passed: number; failures: { case: string; what: string }[] };
