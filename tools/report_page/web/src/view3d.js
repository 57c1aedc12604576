// SPDX-License-Identifier: BSD-3-Clause
// The map to turn: planes seen from the side that was seen, points, the way. Drawn when something changes, not all the time.
import { BufferGeometry, Color, Float32BufferAttribute, Group, Line, LineSegments, LineBasicMaterial, Mesh, MeshBasicMaterial, PerspectiveCamera, Points, PointsMaterial, Scene, ShapeUtils, Vector2, Vector3, WebGLRenderer } from 'three'
import { OrbitControls } from 'three/addons/controls/OrbitControls.js'
import { color, h } from './dom.js'
import { inPlane } from './model.js'
import { isBelowCeiling } from './plan.js'
import { count } from './text.js'
import { inside } from './vector.js'

// Told apart also by those who do not see red and green (after Okabe and Ito), light enough for either background.
const LABEL_COLORS = { wall: '#7f9fc2', floor: '#b5a98f', ceiling: '#c9c9c9', horizontal: '#e0a73e', vertical: '#58a993', other: '#b48ac0', unknown: '#999999' }
const LIGHT = new Vector3(0.35, 0.5, 0.79)

/// Outer rings with the holes in them: [[outer, hole, ...], ...].
function polygons(rings) {
  const depth = rings.map((ring, i) => rings.filter((other, k) => k !== i && inside([other], ...ring[0])).length)
  return rings.flatMap((ring, i) => depth[i] % 2 ? [] : [[ring, ...rings.filter((hole, k) => depth[k] === depth[i] + 1 && inside([ring], ...hole[0]))]])
}

function planeMesh(plane) {
  const frame = inPlane(plane), positions = []
  for (const [outer, ...holes] of polygons(frame.rings.filter((ring) => ring.length >= 3))) {
    const as2d = (ring) => ring.map(([x, y]) => new Vector2(x, y))
    const contour = as2d(outer), inner = holes.map(as2d)
    if (ShapeUtils.isClockWise(contour)) contour.reverse()
    inner.forEach((hole) => { if (!ShapeUtils.isClockWise(hole)) hole.reverse() })
    const all = [contour, ...inner].flat()
    for (const face of ShapeUtils.triangulateShape(contour, inner))
      for (const i of face) {
        const { x, y } = all[i]
        positions.push(...[0, 1, 2].map((k) => plane.center[k] + x * frame.u[k] + y * frame.v[k]))
      }
  }
  const geometry = new BufferGeometry().setAttribute('position', new Float32BufferAttribute(positions, 3))
  const shade = 0.78 + 0.22 * new Vector3(...plane.normal).dot(LIGHT)
  const base = new Color(LABEL_COLORS[plane.label] ?? LABEL_COLORS.unknown).multiplyScalar(Math.min(1, shade))
  return new Mesh(geometry, new MeshBasicMaterial({ color: base, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }))
}

const segments = (pairs, material) => new LineSegments(new BufferGeometry().setAttribute('position', new Float32BufferAttribute(pairs.flat(2), 3)), material)
const edgesOf = (plane) => plane.rings.flatMap((ring) => ring.map((p, i) => [p, ring[(i + 1) % ring.length]]))

function cloud(model, chosen, colorOf, size) {
  const positions = [], colors = [], c = new Color()
  for (let i = 0; i < model.points.n; ++i) {
    if (!chosen(i)) continue
    positions.push(...model.points.positions.subarray(3 * i, 3 * i + 3))
    colorOf(c, i)
    colors.push(c.r, c.g, c.b)
  }
  const geometry = new BufferGeometry().setAttribute('position', new Float32BufferAttribute(positions, 3)).setAttribute('color', new Float32BufferAttribute(colors, 3))
  return new Points(geometry, new PointsMaterial({ size, sizeAttenuation: false, vertexColors: true }))
}

class View {
  constructor(model, box, alt) {
    this.model = model
    this.box = box
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true })  // throws without WebGL
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio || 1))
    const canvas = (this.canvas = this.renderer.domElement)
    for (const [name, value] of Object.entries({ role: 'img', tabindex: '0', 'aria-label': alt })) canvas.setAttribute(name, value)
    box.replaceChildren(canvas)
    this.scene = new Scene()
    this.camera = new PerspectiveCamera(42, 1, 0.02, 500)
    this.camera.up.set(0, 0, 1)
    this.controls = new OrbitControls(this.camera, canvas)
    this.controls.enableZoom = false  // until it is clicked: the page must scroll
    canvas.addEventListener('focus', () => (this.controls.enableZoom = true))
    canvas.addEventListener('blur', () => (this.controls.enableZoom = false))
    canvas.addEventListener('keydown', (event) => this.key(event))
    this.controls.addEventListener('change', () => this.draw())
    this.build()
    this.reset()
    new ResizeObserver(() => requestAnimationFrame(() => this.resize())).observe(box)
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { this.dye(); this.draw() })
  }

  build() {
    const { model } = this
    this.ink = new LineBasicMaterial({})
    this.thin = new LineBasicMaterial({ transparent: true, opacity: 0.45 })
    this.path = new LineBasicMaterial({})
    this.planes = new Group()
    model.planes.forEach((plane) => this.planes.add(planeMesh(plane)))
    this.planes.add(segments(model.planes.flatMap(edgesOf), this.thin), segments(model.lines, this.ink))
    this.way = new Line(new BufferGeometry().setFromPoints(model.trajectory.map((p) => new Vector3(...p))), this.path)
    this.scene.add(this.planes, this.way)
    this.dye()
    if (!model.points) return
    const { colors, planes } = model.points, photo = (c, i) => c.setRGB(colors[3 * i] / 255, colors[3 * i + 1] / 255, colors[3 * i + 2] / 255, 'srgb')
    const ofPlane = (c, i) => c.set(LABEL_COLORS[model.byIndex[planes[i]]?.label] ?? LABEL_COLORS.unknown)
    const below = (i) => isBelowCeiling(model, i)
    this.photo = cloud(model, below, photo, 2)
    this.byPlane = cloud(model, (i) => planes[i] !== -1 && below(i), ofPlane, 2)
    this.missed = cloud(model, (i) => planes[i] === -1, (c) => c.set('#e0452a'), this.box.clientWidth < 600 ? 1.4 : 2.2)
    this.scene.add(this.photo, this.byPlane, this.missed)
  }

  dye() {
    this.ink.color.set(color('--ink'))
    this.thin.color.set(color('--ink'))
    this.path.color.set(color('--accent'))
  }

  /// What is shown: planes and/or points.
  show({ planes, points, way }) {
    this.planes.visible = planes
    this.way.visible = way
    if (this.photo) {
      this.photo.visible = points === 'photo'
      this.byPlane.visible = points === 'plane'
      this.missed.visible = points === 'missed' || points === 'plane'
    }
    this.draw()
  }

  reset() {
    const { low, high } = this.model.bounds, size = Math.max(...high.map((v, k) => v - low[k]), 0.5)
    const middle = low.map((v, k) => (v + high[k]) / 2)
    this.controls.target.set(...middle)
    this.camera.position.set(middle[0] - 0.5 * size, middle[1] - 0.95 * size, middle[2] + 0.85 * size)
    this.camera.near = size / 500
    this.camera.far = size * 20
    this.camera.updateProjectionMatrix()
    this.controls.update()
    this.draw()
  }

  turn(azimuth, tilt, zoom) {
    const offset = this.camera.position.clone().sub(this.controls.target), radius = offset.length() * zoom
    const theta = Math.atan2(offset.y, offset.x) + azimuth, phi = Math.min(1.55, Math.max(-1.5, Math.asin(offset.z / offset.length()) + tilt))
    offset.set(Math.cos(theta) * Math.cos(phi), Math.sin(theta) * Math.cos(phi), Math.sin(phi)).multiplyScalar(radius)
    this.camera.position.copy(this.controls.target).add(offset)
    this.controls.update()
    this.draw()
  }

  key(event) {
    const step = Math.PI / 24
    const moves = { ArrowLeft: [-step, 0, 1], ArrowRight: [step, 0, 1], ArrowUp: [0, step, 1], ArrowDown: [0, -step, 1], '+': [0, 0, 0.85], '=': [0, 0, 0.85], '-': [0, 0, 1 / 0.85] }
    if (event.ctrlKey || event.metaKey || event.altKey) return
    if (event.key === '0' || event.key === 'Home') this.reset()
    else if (moves[event.key]) this.turn(...moves[event.key])
    else return
    event.preventDefault()
  }

  resize() {
    const width = this.box.clientWidth, height = this.box.clientHeight
    if (width < 1 || height < 1) return
    this.renderer.setSize(width, height, false)
    this.camera.aspect = width / height
    this.camera.fov = Math.min(80, 42 * Math.max(1, 0.95 / this.camera.aspect))
    this.camera.updateProjectionMatrix()
    this.draw()
  }

  draw() {
    if (this.waiting) return
    this.waiting = true
    requestAnimationFrame(() => { this.waiting = false; this.renderer.render(this.scene, this.camera) })
  }
}

/// Quietly: three.js reports a missing WebGL as an error on the console before it throws.
function hasWebGL() {
  try {
    return !!document.createElement('canvas').getContext('webgl2')
  } catch {
    return false
  }
}

function buttons(view, model) {
  const state = { planes: true, points: model.points ? 'missed' : 'none', way: true }
  const toggle = (text, name) => {
    const button = h('button', { type: 'button', 'aria-pressed': String(state[name]), onclick: () => {
      state[name] = !state[name]
      button.setAttribute('aria-pressed', String(state[name]))
      view.show(state)
    } }, text)
    return button
  }
  const choices = [['none', 'no points'], ['missed', 'missed points, in red'], ['plane', 'points by plane'], ['photo', 'points as photographed']]
  const choice = h('select', { 'aria-label': 'Which points the 3D view shows', onchange: (event) => { state.points = event.target.value; view.show(state) } },
    choices.map(([value, text]) => h('option', { value, selected: value === state.points }, text)))
  view.show(state)
  return h('div', { class: 'tools' }, toggle('Planes', 'planes'), model.trajectory.length ? toggle('Way', 'way') : null, model.points ? choice : null,
    h('button', { type: 'button', 'aria-label': 'Turn left', onclick: () => view.turn(-Math.PI / 12, 0, 1) }, '⟲'), h('button', { type: 'button', 'aria-label': 'Turn right', onclick: () => view.turn(Math.PI / 12, 0, 1) }, '⟳'),
    h('button', { type: 'button', 'aria-label': 'Nearer', onclick: () => view.turn(0, 0, 0.8) }, '+'), h('button', { type: 'button', 'aria-label': 'Further away', onclick: () => view.turn(0, 0, 1.25) }, '−'),
    h('button', { type: 'button', onclick: () => view.reset() }, 'Reset'))
}

/// The view with its buttons; words in its place where there is no WebGL.
export function view3d(model) {
  const box = h('div', { class: 'frame view3d' }), all = h('figure', {}, box)
  const alt = `The map in three dimensions: ${count(model.planes.length)} planes, seen from above a corner. Arrow keys turn it, plus and minus zoom, 0 resets.`
  let view = null
  try {
    view = hasWebGL() ? new View(model, box, alt) : null
  } catch { /* said below */ }
  if (view === null) {
    box.classList.add('without')
    box.replaceChildren(h('p', {}, 'The view in three dimensions needs WebGL, which this browser does not give. Everything else on this page is complete; planes.glb and planes.ply beside it open in other viewers.'))
    return all
  }
  const used = [...new Set(model.planes.map((plane) => plane.label))].sort()
  all.prepend(buttons(view, model))
  all.append(h('ul', { class: 'key' }, used.map((label) => h('li', {}, h('i', { style: `background:${LABEL_COLORS[label] ?? LABEL_COLORS.unknown}` }), label)),
    model.points ? h('li', {}, h('i', { style: 'background:#e0452a' }), 'on no plane') : null),
    h('figcaption', {}, 'Drag, or focus it and use the arrow keys; + and − zoom, 0 resets; click before you zoom with the wheel. Planes show from the side that was seen, so that walls in front do not hide the room; points at the ceiling are left out.'))
  return all
}
