// What draws: its name, whether that is software, and when it has done what it was told.

const NO_PROCESSOR = /swiftshader|llvmpipe|software|basic render/i;
const ASK_AGAIN_MS = 4;

/** The graphics driver's name for itself. */
export function drawnBy(gl: WebGLRenderingContext | WebGL2RenderingContext): string {
  const named = gl.getExtension('WEBGL_debug_renderer_info');
  return String(gl.getParameter(named === null ? gl.RENDERER : named.UNMASKED_RENDERER_WEBGL));
}

/** Whether a driver of that name draws without a graphics processor. */
export function isSoftware(graphics: string): boolean {
  return NO_PROCESSOR.test(graphics);
}

/** Resolves once all that was drawn is there, without keeping the page waiting. */
export async function finished(gl: WebGL2RenderingContext): Promise<void> {
  const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  if (fence === null) return; // The context is lost, and draws nothing more.
  gl.flush();
  while (gl.clientWaitSync(fence, 0, 0) === gl.TIMEOUT_EXPIRED) {
    await new Promise((again) => setTimeout(again, ASK_AGAIN_MS));
  }
  gl.deleteSync(fence);
}
