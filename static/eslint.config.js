// Lint rules; the restricted imports below are the viewer's layering, stated as a test.
import js from '@eslint/js';
import svelte from 'eslint-plugin-svelte';
import globals from 'globals';
import ts from 'typescript-eslint';

const THREE = {
  group: ['three', 'three/*'],
  message: 'Only the drawing files may import three.js.',
};
const NETWORK = {
  group: [
    '**/connection',
    '**/connection.ts',
    '**/api',
    '**/api.ts',
    '**/protocol',
    '**/protocol.ts',
    '**/surface-frame',
    '**/surface-frame.ts',
  ],
  message: 'Drawing files know no network: app/ hands them plain data.',
};
const SOCKETS = {
  group: ['**/connection', '**/connection.ts', '**/api', '**/api.ts'],
  message: 'Panels and state act through the Actions that app/ gives them.',
};
const DRAWING = {
  group: [
    '**/face',
    '**/face.ts',
    '**/scene',
    '**/scene.ts',
    '**/viewpoint',
    '**/viewpoint.ts',
    '**/sight',
    '**/sight.ts',
    '**/materials',
    '**/materials.ts',
  ],
  message: 'Only app/ knows both the drawing and the rest.',
};
const MAIN = { group: ['**/main', '**/main.ts'], message: 'main.ts is imported by nobody.' };
const PANELS = {
  group: ['svelte', 'svelte/*', '**/panels/*', '**/state/*'],
  message: 'Below the panels.',
};

const forbid = (...patterns) => ({
  'no-restricted-imports': ['error', { patterns: [...patterns, MAIN] }],
});

export default ts.config(
  { ignores: ['node_modules', 'dist', '../service/viewer'] },
  js.configs.recommended,
  ...ts.configs.strict,
  ...svelte.configs.recommended,
  { languageOptions: { globals: { ...globals.browser } } },
  {
    files: ['**/*.svelte', '**/*.svelte.ts'],
    languageOptions: { parserOptions: { parser: ts.parser } },
  },
  {
    rules: {
      '@typescript-eslint/no-non-null-assertion': 'off',
      '@typescript-eslint/consistent-type-imports': 'error',
      'no-console': 'error',
    },
  },
  {
    files: [
      'src/protocol.ts',
      'src/surface-frame.ts',
      'src/connection.ts',
      'src/api.ts',
      'src/throttle.ts',
      'src/tick-rate.ts',
      'src/url.ts',
      'src/views.ts',
      'src/level.ts',
      'src/retold.ts',
      'src/resolution.ts',
      'src/light-presets.ts',
      'src/theme.ts',
      'src/offer.ts',
      'src/shortcuts.ts',
    ],
    rules: forbid(THREE, DRAWING, PANELS),
  },
  {
    files: [
      'src/surface.ts',
      'src/normals.ts',
      'src/strands.ts',
      'src/skin-form.ts',
      'src/wrinkles.ts',
      'src/muscle-shape.ts',
      'src/draped.ts',
      'src/pose.ts',
    ],
    rules: forbid(THREE, NETWORK, PANELS),
  },
  {
    files: [
      'src/face.ts',
      'src/surface-file.ts',
      'src/dressing.ts',
      'src/face-eyes.ts',
      'src/face-nodes.ts',
      'src/gltf-nodes.ts',
      'src/scene.ts',
      'src/sight.ts',
      'src/viewpoint.ts',
      'src/materials.ts',
      'src/lights.ts',
      'src/skin-shader.ts',
      'src/skin-light.ts',
      'src/pores.ts',
      'src/textures.ts',
      'src/tone.ts',
      'src/orbit-keys.ts',
      'src/muscle-view.ts',
    ],
    rules: forbid(NETWORK, PANELS),
  },
  { files: ['src/commands.ts', 'src/edits.ts'], rules: forbid(THREE, DRAWING, SOCKETS) },
  { files: ['src/panels/**', 'src/state/**'], rules: forbid(THREE, DRAWING, SOCKETS) },
);
