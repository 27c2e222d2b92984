// How the viewer is built into the service's folder, and served beside a running service while developing.
/// <reference types="vitest/config" />
import { svelte, vitePreprocess } from '@sveltejs/vite-plugin-svelte';
import { defineConfig } from 'vite';

const SERVICE = process.env.RISORIUS_SERVICE ?? 'http://127.0.0.1:8000';

export default defineConfig({
  base: './',
  plugins: [svelte({ preprocess: vitePreprocess() })],
  build: {
    outDir: '../service/viewer',
    emptyOutDir: true,
    target: 'es2022',
    // three.js is one library that is needed at once; splitting it would only add a round trip.
    chunkSizeWarningLimit: 1000,
    rolldownOptions: {
      input: { index: 'index.html', embed: 'src/embed.ts' },
      // Other pages name it in their source: it keeps its name.
      output: {
        entryFileNames: ({ name }) => (name === 'embed' ? 'embed.js' : 'assets/[name]-[hash].js'),
      },
    },
  },
  server: {
    proxy: { '/api': { target: SERVICE, ws: true, changeOrigin: true } },
  },
  test: { include: ['tests/**/*.test.ts'], environment: 'node' },
});
