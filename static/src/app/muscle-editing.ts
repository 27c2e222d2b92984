// A muscle in hand: its handles on the face, what dragging them changes, and that as edits of the live face.

import { fibresOn } from '../draped';
import type { Face } from '../face';
import type { Carrier, Ground } from '../ground';
import { carrierOf, groundOf } from '../ground';
import type { CarriedHandle } from '../inside/carried';
import { atRest, carriedFibre, ledAsCarried } from '../inside/carried';
import {
  fieldsOf,
  formOf,
  isMuscle,
  mirroredChange,
  onPlane,
  placed,
  twinOf,
} from '../inside/editing';
import { HandleView } from '../inside/handle-view';
import { Newest } from '../inside/newest';
import type { MuscleForm } from '../muscle-shape';
import { SHUT } from '../riding';
import type { Scene } from '../scene';
import type { ViewerState } from '../state/viewer.svelte';
import type { Point } from '../vector';
import { minus, plus } from '../vector';
import type { LayerOverlay } from './layer-overlay';
import type { Overlay } from './on-stage';

type Change = Partial<MuscleForm>;

/** Edits of one field that follow each other within this are undone together [ms]. */
const ONE_GESTURE_MS = 900;
const MOST_KEPT = 100;
const NO_GROUND: Ground = {
  rest: new Float32Array(),
  displacement: () => [0, 0, 0],
  jaw: () => SHUT,
};

/** A place at rest, and what of a muscle follows from where it is. */
interface Touched extends Pick<MuscleForm, 'jaw_share'> {
  place: Point;
}

export interface MuscleEditingParts {
  viewer: ViewerState;
  scene: Scene;
  layers: LayerOverlay;
  /** Change a muscle of the live face. */
  patch: (muscle: string, change: Change) => Promise<unknown>;
}

export class MuscleEditing implements Overlay {
  private face: Face | null = null;
  private ground: Ground = NO_GROUND;
  private carrier: Carrier = carrierOf(NO_GROUND);
  private view: HandleView | null = null;
  /** As the service has them, and as they were when the face was opened. */
  private accepted: Record<string, MuscleForm> = {};
  private first: Record<string, MuscleForm> = {};
  /** The muscles of each gesture as they were before it: both of a pair where both were moved. */
  private readonly before: MuscleForm[][] = [];
  private gesture = '';
  private editedAt = -Infinity;
  /** From what a pointer touches to the place that it drags [mm]. */
  private grip: Point = [0, 0, 0];
  private readonly sending: Newest<Change>;

  constructor(private readonly parts: MuscleEditingParts) {
    this.sending = new Newest(parts.patch, (muscle, error) => {
      parts.viewer.sayWhy(error);
      // What was refused is not so: show the muscle as it is.
      const accepted = this.accepted[muscle];
      if (accepted !== undefined) this.put(muscle, accepted);
    });
  }

  wear(face: Face | null): void {
    this.view?.dispose();
    this.view = null;
    this.face = face;
    this.ground = face === null ? NO_GROUND : groundOf(face);
    this.carrier = carrierOf(this.ground);
    this.refresh();
  }

  /** The rig that the face is on has these muscles. @param isNew whether it is another face. */
  use(muscles: readonly MuscleForm[], isNew: boolean): void {
    const { within } = this.parts.viewer;
    this.accepted = Object.fromEntries(
      muscles.filter(isMuscle).map((muscle) => [muscle.name, muscle]),
    );
    if (isNew) {
      this.first = this.accepted;
      this.before.length = 0;
      within.edits = 0;
      if (!(within.muscle in this.first)) within.muscle = '';
      within.weights = Object.fromEntries(
        Object.entries(within.weights).filter(([name]) => name in this.first),
      );
    }
    // What is on its way yet is newer than what came.
    if (isNew || this.sending.idle) within.forms = { ...this.accepted };
    this.tellChanged();
    this.refresh();
  }

  choose(muscle: string): void {
    const { viewer, layers } = this.parts;
    viewer.within.muscle = muscle;
    this.gesture = '';
    // Without them bone ends go along the picture.
    if (muscle !== '') layers.load().catch(() => undefined);
    this.refresh();
  }

  edit(change: Change, gesture: string): void {
    const { within } = this.parts.viewer;
    const form = within.forms[within.muscle];
    if (form === undefined) return;
    const now = performance.now();
    const moved = this.moved(form);
    const named = `${moved.map(({ name }) => name).join()} ${gesture}`;
    if (named !== this.gesture || now - this.editedAt > ONE_GESTURE_MS) this.keep(moved);
    this.gesture = named;
    this.editedAt = now;
    this.change(form.name, change);
    for (const { name } of moved.slice(1)) this.change(name, mirroredChange(change));
  }

  undo(): void {
    const kept = this.before.pop();
    this.parts.viewer.within.edits = this.before.length;
    this.gesture = '';
    for (const form of kept ?? []) this.change(form.name, formOf(form));
  }

  reset(): void {
    const { within } = this.parts.viewer;
    const form = within.forms[within.muscle];
    if (form === undefined) return;
    const moved = this.moved(form);
    this.keep(moved);
    this.gesture = '';
    for (const { name } of moved) this.change(name, formOf(this.first[name] ?? {}));
  }

  move(): void {
    this.view?.move(this.carrier);
  }

  step(): boolean {
    return false;
  }

  /** Where on the page each handle is drawn [CSS px], by its id. */
  get places(): Record<string, { x: number; y: number }> {
    const { view } = this;
    if (view === null) return {};
    const place = ({ id, drawn }: CarriedHandle) =>
      [id, this.parts.scene.sight.screenPlace(view.world(drawn))] as const;
    return Object.fromEntries(view.handles.map(place));
  }

  /** The handle that is drawn nearest to a place of the page, if it is within `reach` CSS pixels. */
  handleAt(x: number, y: number, reach: number): CarriedHandle | null {
    let [found, least]: [CarriedHandle | null, number] = [null, reach];
    for (const handle of this.view?.handles ?? []) {
      const at = this.parts.scene.sight.screenPlace(this.view!.world(handle.drawn));
      const away = Math.hypot(at.x - x, at.y - y);
      if (away < least) [found, least] = [handle, away];
    }
    return found;
  }

  /** The muscle whose fibres are drawn nearest to a place of the page. */
  muscleAt(x: number, y: number, reach: number): string {
    const { scene, viewer } = this.parts;
    let [found, least] = ['', reach];
    if (this.view === null && !this.show()) return '';
    for (const form of Object.values(viewer.within.forms)) {
      for (const fibre of fibresOn(form, this.ground)) {
        for (const point of carriedFibre(fibre, this.carrier)) {
          const at = scene.sight.screenPlace(this.view!.world(point));
          const away = Math.hypot(at.x - x, at.y - y);
          if (away < least && scene.sight.facing(this.view!.world(point)))
            [found, least] = [form.name, away];
        }
      }
    }
    return found;
  }

  /** A pointer takes a handle at a place of the page. */
  grab(handle: CarriedHandle, x: number, y: number): void {
    const touched = this.touched(handle, x, y);
    this.grip = touched === null ? [0, 0, 0] : minus(handle.place, touched.place);
  }

  /** And leads it to another. */
  drag(handle: CarriedHandle, x: number, y: number): void {
    const { within } = this.parts.viewer;
    const form = within.forms[within.muscle];
    if (form === undefined) return;
    if (handle.along === 'line' || handle.along === 'arc') {
      const ray = this.parts.scene.sight.rayIn(this.view!.group, x, y);
      this.edit(ledAsCarried(form, handle.id, ray, this.carrier), handle.id);
      return;
    }
    const touched = this.touched(handle, x, y);
    if (touched === null) return;
    const { place, ...share } = touched;
    this.edit({ ...placed(form, handle.id, plus(place, this.grip)), ...share }, handle.id);
  }

  /** Where a pointer touches what the handle goes along, as that is at rest [mm]; of a linear muscle's bone how it rides. */
  private touched(handle: CarriedHandle, x: number, y: number): Touched | null {
    const { scene, layers, viewer } = this.parts;
    const form = viewer.within.forms[viewer.within.muscle];
    if (form === undefined) return null;
    if (handle.along === 'skin') {
      const hit = scene.sight.hit(this.face!.skin, x, y);
      if (hit !== null) return { place: this.face!.restOf(hit.corners, hit.weights) };
    }
    const skull = handle.along === 'bone' ? layers.skull : null;
    if (skull !== null) {
      skull.stand(this.ground.jaw());
      const hit = scene.sight.hit(skull.mesh, x, y);
      if (hit !== null) {
        const { place, share } = skull.under(hit);
        return form.kind === 'linear' ? { place, jaw_share: share } : { place };
      }
    }
    // Beside the head, or before its layers are there: along the picture, through where it is drawn.
    const ray = scene.sight.rayIn(this.view!.group, x, y);
    const hit = onPlane(ray, handle.drawn, ray.direction);
    return hit === null ? null : { place: atRest(form, handle, hit, this.carrier) };
  }

  private change(muscle: string, change: Change): void {
    const form = this.parts.viewer.within.forms[muscle];
    if (form === undefined) return;
    this.put(muscle, { ...form, ...change });
    this.sending.put(muscle, fieldsOf(change));
  }

  private put(muscle: string, form: MuscleForm): void {
    const { within } = this.parts.viewer;
    within.forms = { ...within.forms, [muscle]: form };
    this.tellChanged();
    this.refresh();
  }

  /** The muscle in hand, and that of the other side where both are moved. */
  private moved(form: MuscleForm): MuscleForm[] {
    const { within } = this.parts.viewer;
    const twin = within.mirrored ? within.forms[twinOf(form.name)] : undefined;
    return twin === undefined ? [form] : [form, twin];
  }

  private keep(forms: MuscleForm[]): void {
    this.before.push(forms);
    if (this.before.length > MOST_KEPT) this.before.shift();
    this.parts.viewer.within.edits = this.before.length;
  }

  private tellChanged(): void {
    const { within } = this.parts.viewer;
    const differs = (form: MuscleForm): boolean =>
      JSON.stringify(fieldsOf(form)) !== JSON.stringify(fieldsOf(this.first[form.name] ?? form));
    within.changed = Object.values(within.forms)
      .filter(differs)
      .map(({ name }) => name);
  }

  private refresh(): void {
    const { viewer, scene } = this.parts;
    if (this.view !== null || viewer.within.muscle !== '') this.show();
    scene.invalidate();
  }

  /** Tells whether there is a face to show handles on. */
  private show(): boolean {
    if (this.face === null) return false;
    const { within } = this.parts.viewer;
    if (this.view === null) {
      this.view = new HandleView();
      this.face.carry(this.view.group);
    }
    this.view.show(within.forms[within.muscle] ?? null, this.carrier);
    return true;
  }
}
