using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Reflection;
using System.Text;

/// <summary>
/// Compiles and runs programs in one process, so that neither the compiler nor the runtime is started for each: `mono host.exe`.
/// A line read is words between tabs: `compile` and what mcs takes, or `run`, a program and its arguments. A line written is the exit
/// code and, in base 64, what it said. A program is loaded once: its statics stay, and it needs a name of its own.
/// </summary>
public static class Host
{
    private static readonly Dictionary<string, Assembly> programs = new Dictionary<string, Assembly>();
    private static MethodInfo compiler;

    public static void Main()
    {
        var utf8 = new UTF8Encoding(false);
        var asked = new StreamReader(Console.OpenStandardInput(), utf8);
        var answers = new StreamWriter(Console.OpenStandardOutput(), utf8) { AutoFlush = true };
        for (string line = asked.ReadLine(); line != null; line = asked.ReadLine())
        {
            string[] words = line.Split('\t');
            var said = new StringWriter(CultureInfo.InvariantCulture);
            int code;
            Console.SetOut(said);
            try
            {
                code = words[0] == "compile" ? Compile(words.Skip(1).ToArray(), said) : Run(words[1], words.Skip(2).ToArray());
            }
            catch (Exception error)
            {
                code = -1;
                said.WriteLine(error is TargetInvocationException ? error.InnerException : error);
            }
            answers.WriteLine(code + "\t" + Convert.ToBase64String(utf8.GetBytes(said.ToString())));
        }
    }

    /// <summary>The compiler lies beside the library of this runtime, and can be called.</summary>
    private static int Compile(string[] words, TextWriter said)
    {
        if (compiler == null)
        {
            string home = Path.GetDirectoryName(typeof(object).Assembly.Location);
            Assembly mcs = Assembly.LoadFrom(Path.Combine(home, "mcs.exe"));
            compiler = mcs.GetType("Mono.CSharp.CompilerCallableEntryPoint", true).GetMethod("InvokeCompiler");
        }
        return (bool)compiler.Invoke(null, new object[] { words, said }) ? 0 : 1;
    }

    private static int Run(string path, string[] arguments)
    {
        Assembly program;
        if (!programs.TryGetValue(path, out program))
        {
            program = Assembly.LoadFrom(path); // with the libraries beside it
            programs[path] = program;
        }
        object code = program.EntryPoint.Invoke(null, program.EntryPoint.GetParameters().Length == 0 ? null : new object[] { arguments });
        return code == null ? 0 : (int)code;
    }
}
