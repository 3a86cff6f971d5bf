"use strict";
// read-outs of the charts: the values at the frame under the mouse, in all charts at once
document.documentElement.classList.add("js");

const charts = [...document.querySelectorAll(".chart")].map((figure) => {
  const {first, last, low, high, digits} = figure.dataset;
  const lines = [...figure.querySelectorAll(".plot .line")].map((group) =>
    [...group.children].flatMap((line) => line.getAttribute("points").split(" ").map((point) =>
      point.split(",").map(Number))));
  const cursor = document.createElement("span");
  cursor.className = "at";
  cursor.hidden = true;
  figure.querySelector(".plot").append(cursor);
  return {
    figure, lines, cursor, outputs: [...figure.querySelectorAll("output")],
    first: +first, last: +last, low: +low, high: +high, digits: +digits,
  };
});

function nearest(points, x) {
  let low = 0;
  let high = points.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (points[middle][0] < x) low = middle + 1;
    else high = middle;
  }
  const before = points[low - 1];
  return before && x - before[0] < points[low][0] - x ? before : points[low];
}

function read(chart, share) {
  const frame = Math.min(Math.floor(chart.last),
    Math.round(chart.first + share * (chart.last - chart.first)));
  const x = 1000 * (frame - chart.first) / (chart.last - chart.first);
  const reach = Math.max(1, 500 / (chart.last - chart.first));
  chart.lines.forEach((points, index) => {
    const point = points.length ? nearest(points, x) : null;
    const near = point && Math.abs(point[0] - x) <= reach;
    const value = near && chart.high - point[1] / 1000 * (chart.high - chart.low);
    chart.outputs[index].textContent = near ? value.toFixed(chart.digits) : "–";
  });
  chart.cursor.hidden = false;
  chart.cursor.classList.toggle("left", x > 850);
  chart.cursor.style.left = x > 850 ? "auto" : `${x / 10}%`;
  chart.cursor.style.right = x > 850 ? `${100 - x / 10}%` : "auto";
  chart.cursor.textContent = `frame ${frame}`;
  chart.figure.classList.add("reading");
}

function forget(chart) {
  chart.cursor.hidden = true;
  chart.figure.classList.remove("reading");
  chart.outputs.forEach((output) => { output.textContent = output.dataset.mean; });
}

charts.forEach((chart) => {
  chart.outputs.forEach((output) => { output.dataset.mean = output.textContent; });
  const plot = chart.figure.querySelector(".plot");
  plot.addEventListener("pointermove", (event) => {
    const box = plot.getBoundingClientRect();
    const share = Math.min(1, Math.max(0, (event.clientX - box.left) / box.width));
    charts.forEach((other) => read(other, share));
  });
  plot.addEventListener("pointerleave", () => charts.forEach(forget));
  const groups = chart.figure.querySelectorAll(".plot .line");
  chart.figure.querySelectorAll(".key li").forEach((entry, index) => {
    const light = (on) => () => {
      chart.figure.classList.toggle("dim", on);
      entry.classList.toggle("lit", on);
      groups[index].classList.toggle("lit", on);
    };
    entry.addEventListener("pointerenter", light(true));
    entry.addEventListener("pointerleave", light(false));
  });
});

document.querySelectorAll(".pictures img").forEach((image) => {
  image.addEventListener("click", () => image.closest("figure").classList.toggle("wide"));
});
