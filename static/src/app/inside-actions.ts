// What the panel of the inside does.

import type { Api } from '../api';
import type { Commands } from '../commands';
import type { InsideActions } from '../state/inside-actions';
import type { ViewerState } from '../state/viewer.svelte';
import type { BesideOverlay } from './beside-overlay';
import type { HeatOverlay } from './heat-overlay';
import type { LayerOverlay } from './layer-overlay';
import type { MuscleEditing } from './muscle-editing';
import type { TrailOverlay } from './trail-overlay';

export interface InsideParts {
  api: Api;
  viewer: ViewerState;
  commands: Commands;
  heat: HeatOverlay;
  layers: LayerOverlay;
  trails: TrailOverlay;
  beside: BesideOverlay;
  editing: MuscleEditing;
  /** Of the rig that the face is on. */
  rigId: () => string;
  /** Show or hide the muscles. */
  setMuscles: (shown: boolean) => void;
  switchRig: (rig: string) => void;
}

export function insideActions(parts: InsideParts): InsideActions {
  const { api, viewer, commands, heat, layers, trails, beside, editing } = parts;
  const { within } = viewer;
  /** Muscles that the trial of a new unit holds. */
  let tried: string[] = [];
  return {
    setHeat(by) {
      within.heat = by;
      heat.refresh();
    },
    setPeel(to) {
      within.peel = to;
      layers.refresh();
    },
    setCut(x) {
      within.cut = x;
      layers.refresh();
    },
    setSprings(kind, shown) {
      within[kind] = shown;
      layers.refresh();
    },
    setTrails(shown) {
      within.trails = shown;
      trails.refresh();
    },
    setTrailSeconds(seconds) {
      within.seconds = seconds;
      trails.refresh();
    },
    holdMoment() {
      within.held = beside.hold();
      heat.hold(within.held);
    },
    dropMoment() {
      beside.drop();
      within.held = false;
      heat.hold(false);
    },
    setBeside(who) {
      within.beside = who;
      beside.refresh();
    },
    chooseMuscle(name) {
      if (name !== '' && !viewer.inside) parts.setMuscles(true);
      editing.choose(name);
    },
    editMuscle(change, gesture) {
      editing.edit(change, gesture);
    },
    undoMuscle() {
      editing.undo();
    },
    resetMuscle() {
      editing.reset();
    },
    weigh(muscle, weight) {
      if (weight === null) Reflect.deleteProperty(within.weights, muscle);
      else within.weights[muscle] = weight;
    },
    tryUnit(share) {
      const wanted = share > 0 ? Object.entries(within.weights) : [];
      const names = new Set(wanted.map(([name]) => name));
      for (const name of tried) if (!names.has(name)) commands.letGo('muscles', name);
      for (const [name, weight] of wanted)
        commands.set('muscles', name, Math.min(1, share * weight));
      tried = [...names];
    },
    async saveRig(name, unit) {
      const muscles = { ...within.weights };
      const units =
        unit === '' || Object.keys(muscles).length === 0
          ? {}
          : { action_units: { [unit]: { muscles, title: unit } } };
      try {
        const { id } = await api.saveRig({ base: parts.rigId(), name, ...units });
        within.weights = {};
        parts.switchRig(id);
        viewer.tell(
          `Saved as ${name}${unit === '' ? '' : `, with ${unit} among its action units`}.`,
        );
      } catch (error) {
        viewer.sayWhy(error);
      }
    },
  };
}
