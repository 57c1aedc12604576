// SPDX-License-Identifier: BSD-3-Clause
// One file out: ../page/report.html, with script, style and licences inside, and the marker that planemap puts its data at.
import { createHash } from 'node:crypto'
import { readdirSync, readFileSync } from 'node:fs'
import { defineConfig } from 'vite'

const here = new URL('.', import.meta.url).pathname

/// SHA-256 of what the page is made of, names in order: tests/report_page compares it with the sources as they are.
function sourcesDigest() {
  const files = ['index.html', 'package-lock.json', 'vite.config.js']
  for (const name of readdirSync(here + 'src')) files.push('src/' + name)
  const hash = createHash('sha256')
  for (const name of files.sort()) hash.update(readFileSync(here + name))
  return hash.digest('hex')
}

function oneFile() {
  return {
    name: 'one-file',
    enforce: 'post',
    generateBundle(_, bundle) {
      const page = bundle['index.html']
      let html = page.source
      const licence = readFileSync(here + 'node_modules/three/LICENSE', 'utf8')
      for (const [name, item] of Object.entries(bundle)) {
        if (name.endsWith('.js')) {
          const code = item.code.replaceAll('</script', '<\\/script').replaceAll('<!--', '<\\!--')
          html = html.replace(/\s*<script type="module"[^>]*src="[^"]*"[^>]*><\/script>/, '')
          html = html.replace('</body>', () => `<script type="module">\n/*! three.js\n\n${licence.trim()}\n*/\n${code}</script>\n</body>`)
        } else if (name.endsWith('.css')) {
          html = html.replace(/\s*<link rel="stylesheet"[^>]*>/, () => `\n<style>${item.source}</style>`)
        } else {
          continue
        }
        delete bundle[name]
      }
      page.source = html.replace('<head>', `<head>\n<meta name="planemap-sources" content="${sourcesDigest()}">`)
      page.fileName = 'report.html'
      this.emitFile({ type: 'asset', fileName: 'LICENSE.three.txt', source: licence })
    },
  }
}

export default defineConfig({
  plugins: [oneFile()],
  base: './',
  build: {
    outDir: '../page',
    emptyOutDir: false,
    target: 'es2022',
    modulePreload: false,
    cssCodeSplit: false,
    assetsInlineLimit: Infinity,
    chunkSizeWarningLimit: 2000,
  },
})
