// The edits to three's shaders find their lines in the version that is installed.

import type { WebGLRenderer } from 'three';
import { AgXToneMapping, ShaderChunk, ShaderLib } from 'three';
import { describe, expect, it } from 'vitest';
import type { Program } from '../src/shader-edit';
import { EyeSetting, makeCornea, makeEyeball } from '../src/eye-shader';
import { makeOral } from '../src/mouth-shader';
import { makeSkin } from '../src/skin-shader';
import { exposeSkin } from '../src/tone';

function physical(): Program {
  const { vertexShader, fragmentShader } = ShaderLib.physical;
  return { vertexShader, fragmentShader, uniforms: {} };
}

/** The program of skin that has every map. */
function skinProgram(): Program {
  const program = physical();
  const value = { value: null };
  makeSkin(program, {
    neckFade: value,
    peelCut: value,
    mapsShown: value,
    albedoMap: value,
    reliefMap: value,
    ormMap: value,
    wrinkleMap: value,
    poreMap: value,
  });
  return program;
}

describe('the skin s program', () => {
  it('answers lights in its own way, with shadows and surroundings of its own', () => {
    const program = skinProgram();
    expect(program.fragmentShader).toContain('#define RE_Direct RE_Direct_Skin');
    expect(program.fragmentShader).toContain('scatteredShadow( ( directLight.visible');
    expect(program.fragmentShader).toContain('skinSmooth, 0.65 * skinBare');
    expect(program.uniforms).toHaveProperty('poreMap');
    // Of skin that is peeled the walls of the mouth stay.
    expect(program.fragmentShader).toMatch(
      /if \(vWall < 0\.9\) \{\s*diffuseColor\.a \*= leftOfPeel\(\);/,
    );
  });

  it('darkens the floors of furrows, not their walls, and shades broad folds in every colour', () => {
    const program = skinProgram();
    expect(program.fragmentShader).toContain('float depth = vWrinkle * (1.0 - furrows.z)');
    expect(program.fragmentShader).toContain('vec3(dot(skinFolded, light)), BLUR');
    const [red, green, blue] = /FURROW vec3\((.*?), (.*?), (.*?)\)/
      .exec(program.fragmentShader)!
      .slice(1)
      .map(Number) as [number, number, number];
    expect(Math.max(red, green, blue) - Math.min(red, green, blue)).toBeLessThan(0.08);
  });

  it('lets light from behind reach only edges that stand free', () => {
    const program = skinProgram();
    expect(program.fragmentShader).toMatch(/float edge = .*smoothstep\(0\.78, 0\.92, skinOpen\)/);
  });

  it('draws the walls of the mouth behind what lies in it', () => {
    const program = skinProgram();
    expect(program.vertexShader).toContain('gl_Position.z = behind.z');
  });
});

describe('the eye s programs', () => {
  const setting = new EyeSetting(-1, { value: null });

  it('puts an iris behind the cornea, and keeps the highlight before it', () => {
    const program = physical();
    makeCornea(program, setting);
    expect(program.fragmentShader).toContain('refract(');
    expect(program.fragmentShader).not.toContain('<opaque_fragment>');
    expect(program.uniforms).toHaveProperty('eyeMap');
  });

  it('shades the ball under the lids', () => {
    const program = physical();
    makeEyeball(program, setting);
    expect(program.fragmentShader).toContain('lidShade(vInEye)');
    expect(setting.lids.value.z).toBe(-1);
  });
});

describe('the mouth s program', () => {
  it('mirrors nothing where no light comes', () => {
    const program = physical();
    makeOral(program);
    expect(program.fragmentShader).toContain('clearcoatSpecularDirect *= reached');
  });
});

describe('the tone curve', () => {
  it('gets its look once', () => {
    const renderer = {} as WebGLRenderer;
    exposeSkin(renderer);
    exposeSkin(renderer);
    expect(renderer.toneMapping).toBe(AgXToneMapping);
    expect(ShaderChunk.tonemapping_pars_fragment.split('0.2126, 0.7152').length).toBe(2);
  });
});
