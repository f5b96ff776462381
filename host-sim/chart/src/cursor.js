// A cursor and a zoom for the charts. Without it the page is complete, and still.
(() => {
  const number = value => Number(value.toPrecision(4)).toString().replace('-', '\u2212');
  const axis = text => {
    const [lo, hi, log, ...label] = text.split(' ');
    const back = log === '1' ? value => 10 ** value : value => value;
    return { lo: +lo, hi: +hi, label: label.join(' '), at: part => back(+lo + part * (hi - lo)) };
  };
  // Places in drawing units, 1000 wide; a move begins a new curve.
  const places = path => [...path.getAttribute('d').matchAll(/([ML])(-?[\d.]+) (-?[\d.]+)/g)]
    .map(([, kind, x, y]) => [+x, +y, kind === 'L']);
  const meets = (points, x) => {
    for (let k = 1; k < points.length; k++) {
      const [[x0, y0], [x1, y1, joined]] = [points[k - 1], points[k]];
      if (joined && (x0 - x) * (x1 - x) <= 0 && x0 !== x1) return y0 + (y1 - y0) * (x - x0) / (x1 - x0);
    }
    return null;
  };
  const charts = [...document.querySelectorAll('.chart[data-x]')].map(box => {
    const svg = box.querySelector('svg');
    const x = axis(box.dataset.x);
    const y = box.dataset.y && axis(box.dataset.y);
    const height = +box.dataset.height;
    const curves = [...svg.querySelectorAll('svg .curve:not(.wall, .sensed, .shade)')]
      .map(path => [path.getAttribute('class').replace('curve', '').trim().replaceAll('-', ' '), places(path)]);
    const line = svg.querySelector('line.grid').cloneNode();
    line.setAttribute('class', 'cursor');
    line.setAttribute('y1', 0);
    line.setAttribute('y2', height);
    line.style.display = 'none';
    svg.append(line);
    const tools = document.createElement('p');
    tools.className = 'tools';
    const said = document.createElement('output');
    tools.append(said);
    box.after(tools);
    return { box, svg, x, y, height, curves, line, tools, said, part: 0.5, zoom: 1 };
  });
  const show = (chart, part) => {
    const value = chart.x.at(Math.min(1, Math.max(0, part)));
    for (const other of charts.filter(it => it === chart || it.x.label === chart.x.label)) {
      const at = other === chart ? part : (value - other.x.lo) / (other.x.hi - other.x.lo);
      const shown = at >= 0 && at <= 1;
      other.line.style.display = shown ? '' : 'none';
      if (!shown) { other.said.value = ''; continue; }
      other.part = at;
      for (const end of ['x1', 'x2']) other.line.setAttribute(end, `${100 * at}%`);
      const read = other.y ? other.curves.map(([name, points]) => [name, meets(points, 1000 * at)]) : [];
      const values = read.filter(it => it[1] !== null)
        .map(([name, y]) => `${name} ${number(other.y.at(1 - y / other.height))}`);
      other.said.value = [`${other.x.label}: ${number(value)}`, ...values].join(', ');
    }
  };
  const magnify = (chart, zoom) => {
    chart.zoom = Math.min(64, Math.max(1, zoom));
    chart.svg.style.width = chart.zoom > 1 ? `${100 * chart.zoom}%` : '';
    chart.box.classList.toggle('zoomed', chart.zoom > 1);
    chart.box.scrollLeft = chart.part * chart.svg.clientWidth - chart.box.clientWidth / 2;
  };
  const keys = {
    ArrowLeft: it => show(it, it.part - 0.01 / it.zoom), ArrowRight: it => show(it, it.part + 0.01 / it.zoom),
    Home: it => show(it, 0), End: it => show(it, 1),
    '+': it => magnify(it, 2 * it.zoom), '-': it => magnify(it, it.zoom / 2), 0: it => magnify(it, 1),
  };
  for (const chart of charts) {
    const { box, svg, tools } = chart;
    box.tabIndex = 0;
    box.setAttribute('role', 'group');
    box.setAttribute('aria-label',
      `${svg.querySelector('title').textContent}. Arrow keys move a cursor, plus and minus zoom, 0 shows all.`);
    svg.addEventListener('pointermove', event => {
      const frame = svg.getBoundingClientRect();
      show(chart, Math.min(1, Math.max(0, (event.clientX - frame.left) / frame.width)));
    });
    box.addEventListener('keydown', event => {
      const act = keys[event.key];
      if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      act(chart);
    });
    for (const [sign, key, name] of [['+', '+', 'Zoom in'], ['\u2212', '-', 'Zoom out'], ['all', '0', 'Show all']]) {
      const button = document.createElement('button');
      button.type = 'button';
      button.textContent = sign;
      button.title = name;
      button.setAttribute('aria-label', name);
      button.addEventListener('click', () => keys[key](chart));
      tools.append(button);
    }
    chart.said.setAttribute('aria-live', 'polite');
  }
})();
