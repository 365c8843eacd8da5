/* The charts of a study, each in the element of its number. */

const charts = JSON.parse(document.getElementById("data").textContent);
charts.forEach(({ traces, layout }, number) => {
  Plotly.newPlot(`chart${number}`, traces, layout, { responsive: true, displaylogo: false });
});
