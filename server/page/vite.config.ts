import { resolve } from 'node:path';

import { defineConfig } from 'vite';

// Two pages, whole files with hashed names: the program serves them as they are, under a policy that
// allows scripts and styles of its own address only.
export default defineConfig({
  build: {
    outDir: process.env.SYMCELL_PAGE_OUT ?? 'dist',
    emptyOutDir: true,
    target: 'es2022',
    assetsInlineLimit: 0,
    modulePreload: false,
    chunkSizeWarningLimit: 1200,
    rollupOptions: {
      input: { index: resolve(import.meta.dirname, 'index.html'), docs: resolve(import.meta.dirname, 'docs.html') },
    },
  },
});
