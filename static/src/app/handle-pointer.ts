// The pointer on the stage while muscles are edited: takes handles before the camera does, and chooses muscles by a click.

import type { CarriedHandle } from '../inside/carried';
import type { ViewerState } from '../state/viewer.svelte';
import type { MuscleEditing } from './muscle-editing';

/** How near a pointer must come to a handle, and a finger [CSS px]. */
const REACH = 16;
const FINGER_REACH = 30;
/** A press that goes no further is a click [CSS px]. */
const CLICK = 5;
const NEAR_FIBRE = 14;

export function editByPointer(
  canvas: HTMLCanvasElement,
  viewer: ViewerState,
  editing: MuscleEditing,
): void {
  let held: CarriedHandle | null = null;
  let pressed: { x: number; y: number } | null = null;

  const handleUnder = ({ clientX, clientY, pointerType }: PointerEvent): CarriedHandle | null =>
    viewer.within.muscle === '' || viewer.within.beside !== 'off'
      ? null
      : editing.handleAt(clientX, clientY, pointerType === 'touch' ? FINGER_REACH : REACH);

  // In the phase before the camera's own listeners, which are on the canvas too.
  const listen = (
    type: 'pointerdown' | 'pointermove' | 'pointerup',
    run: (event: PointerEvent) => void,
  ): void => {
    canvas.addEventListener(type, run, { capture: true });
  };
  listen('pointerdown', (event) => {
    pressed = { x: event.clientX, y: event.clientY };
    held = event.button === 0 ? handleUnder(event) : null;
    if (held === null) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    canvas.setPointerCapture(event.pointerId);
    editing.grab(held, event.clientX, event.clientY);
  });
  listen('pointermove', (event) => {
    if (held === null) {
      if (event.buttons === 0) canvas.classList.toggle('over-handle', handleUnder(event) !== null);
      return;
    }
    event.stopImmediatePropagation();
    editing.drag(held, event.clientX, event.clientY);
  });
  listen('pointerup', (event) => {
    const { clientX: x, clientY: y } = event;
    const clicked = pressed !== null && Math.hypot(x - pressed.x, y - pressed.y) < CLICK;
    pressed = null;
    if (held !== null) {
      held = null;
      event.stopImmediatePropagation();
      canvas.releasePointerCapture(event.pointerId);
    } else if (clicked && viewer.inside && viewer.within.beside === 'off') {
      const muscle = editing.muscleAt(x, y, NEAR_FIBRE);
      if (muscle !== '') editing.choose(muscle);
    }
  });
}
