// Hair on cards is drawn twice: what is solid hides, what is thin is blended over it.

import type {
  MeshPhysicalMaterial,
  WebGLProgramParametersWithUniforms,
  WebGLRenderer,
} from 'three';
import { BufferGeometry, DataTexture, Group, Mesh, ShaderLib, Texture } from 'three';
import { describe, expect, it } from 'vitest';
import { addFringe, FRINGE } from '../src/fringe';
import { createMaterial } from '../src/materials';
import { NOTHING_PEELED } from '../src/peel';
import { sketch } from '../src/sketch';

const setting = {
  vertexColors: true,
  inMouth: false,
  map: new Texture(),
  neckFade: null,
  peelCut: { value: NOTHING_PEELED },
  maps: null,
  eye: null,
};

function made(kind: string): {
  material: MeshPhysicalMaterial;
  program: WebGLProgramParametersWithUniforms;
} {
  const material = createMaterial(kind, setting) as MeshPhysicalMaterial;
  const { vertexShader, fragmentShader } = ShaderLib.physical;
  const program = { vertexShader, fragmentShader, uniforms: {} };
  material.onBeforeCompile(
    program as WebGLProgramParametersWithUniforms,
    null as unknown as WebGLRenderer,
  );
  return { material, program: program as WebGLProgramParametersWithUniforms };
}

describe('the solid and the thin of cards', () => {
  it('are one program, which draws each where the other leaves off', () => {
    const [solid, thin] = [made('hair'), made(FRINGE)];
    expect(thin.program.fragmentShader).toBe(solid.program.fragmentShader);
    expect(thin.material.customProgramCacheKey()).toBe(solid.material.customProgramCacheKey());
    expect(solid.program.uniforms.fringe).toEqual({ value: false });
    expect(thin.program.uniforms.fringe).toEqual({ value: true });
    expect(solid.program.fragmentShader).toContain('if (solid == fringe');
    expect(solid.program.fragmentShader).not.toContain('float grain');
  });

  it('hide and are blended, and leave no pixel to its samples', () => {
    const [solid, thin] = [made('hair').material, made(FRINGE).material];
    expect([solid.depthWrite, thin.depthWrite]).toEqual([true, false]);
    expect(solid.blending).not.toBe(thin.blending);
    expect(solid.alphaToCoverage || thin.alphaToCoverage).toBe(false);
    // In two draws those seen from behind would be lit from behind.
    expect(solid.forceSinglePass && thin.forceSinglePass).toBe(true);
  });

  it('go together, throw one shadow, and are cut where hair is', () => {
    const cards = new Mesh(new BufferGeometry(), made('hair').material);
    addFringe(cards, made(FRINGE).material, 4);
    const fringe = cards.children[0] as Mesh;
    expect(fringe.geometry).toBe(cards.geometry);
    expect(fringe.castShadow).toBe(false);
    expect(fringe.renderOrder).toBeGreaterThan(cards.renderOrder);
    expect(fringe.userData).toEqual({ material: FRINGE, role: 'strands' });
  });

  it('are one in a sketch', () => {
    const { material } = made('hair');
    material.map = new DataTexture(new Uint8Array(4), 1, 1);
    const cards = new Mesh(new BufferGeometry(), material);
    cards.userData.material = 'hair';
    addFringe(cards, made(FRINGE).material, 4);
    const restore = sketch(new Group().add(cards));
    expect([cards.visible, cards.children[0]!.visible]).toEqual([true, false]);
    restore();
    expect(cards.children[0]!.visible).toBe(true);
  });
});
